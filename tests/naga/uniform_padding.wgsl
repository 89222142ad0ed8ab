struct L { p: vec3f, r: f32, c: vec3f }
struct S { n: u32, l: array<L, 3>, m: mat3x3f, x: vec2f, y: vec3f, z: f32, w: array<vec4f, 2>, q: mat4x3f, e: L, t: f32 }
@group(0) @binding(0) var<uniform> s: S;
@fragment fn fs_main(@location(0) @interpolate(flat) i: u32) -> @location(0) vec4f { let l = s.l[i]; var all = s; all.n = 2; return vec4f(l.p * l.r + s.l[1].c, s.z) + vec4f(s.m * s.y, s.t) + s.w[i] + vec4f(s.q * s.w[0], f32(all.n)) + vec4f(s.e.c, s.x.y); }
