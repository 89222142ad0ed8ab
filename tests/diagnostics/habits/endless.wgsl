fn shade(x: f32) -> f32 { if x > 1.0 { return 2.0; } }
@fragment fn fs_main(@location(0) x: f32) -> @location(0) vec4f { return vec4f(shade(x)); }
