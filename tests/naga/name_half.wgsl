struct half { half: f32, complex: f32 } struct complex { a: half }
@group(0) @binding(0) var<uniform> u: complex;
@fragment fn main() -> @location(0) vec4f { let half = u.a.half; return vec4f(half, u.a.complex, 1, 1); }
