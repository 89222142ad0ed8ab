const f32max = 0x1.fffffep+127;
@fragment fn fs_main(@location(0) x: f32) -> @location(0) vec4f { return vec4f(select(0.0, 1.0, x >= f32max)); }
