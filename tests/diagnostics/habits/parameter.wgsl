fn f(x: f32) -> f32 { x -= 1.0; return x; }
@fragment fn fs_main(@location(0) v: f32) -> @location(0) vec4f { return vec4f(f(v)); }
