fn f(a: u32) -> u32 { return 2 & 4 >> 1; }
@fragment fn m(@location(0) x: vec4f) -> @location(0) vec4f { return vec4f(f32(f(1))); }
