fn srgb(c: vec4f) -> vec4f { let cut = vec4f(c < vec4f(0.5)); return vec4f(vec4f(c)) * cut + vec4f(f32(1.0)); }
@fragment fn main(@location(0) c: vec4f) -> @location(0) vec4f { return srgb(c); }
