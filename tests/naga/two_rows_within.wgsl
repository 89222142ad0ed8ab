struct I { @align(16) m: mat2x2f, @align(16) n: mat3x2f }
struct S { @align(16) a: array<I, 2>, @align(16) b: mat2x2f, c: f32 }
@group(0) @binding(0) var<uniform> s: S;
@fragment fn fs(@location(0) @interpolate(flat) i: u32) -> @location(0) vec4f { let t = s.a[i]; let u = s; return vec4f(t.m * vec2f(1), s.a[1].n[i]) + vec4f(u.b[i], s.b[i][1], s.c); }
