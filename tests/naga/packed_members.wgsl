struct S { a: vec3f, b: f32, c: vec3u, d: array<vec3i, 2>, e: f32 }
@group(0) @binding(0) var<storage, read_write> s: S;
@compute @workgroup_size(1) fn cs_main() { s.a.y = 2; s.a = s.a.zyx * 2; s.c += vec3u(1); s.d[1].z = s.d[0].x; s.a[s.c.x] = dot(s.a, s.a); let l = length(s.a) + max(s.a, vec3f(0)).x; s.e = l; var t = s; t.a *= mat3x3f(1,0,0,0,1,0,0,0,1); s = t; s.a = cross(s.a, select(s.a, -s.a, s.a < vec3f(1))); }
