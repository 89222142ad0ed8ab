@group(0) @binding(0) var<storage, read_write> dst: vec3f;
@group(0) @binding(1) var<storage, read_write> h: vec3f;
@group(0) @binding(2) var<uniform> u: vec3i;
@group(0) @binding(3) var<uniform> Packed: vec3u;
fn f(p: ptr<storage, vec3f, read_write>, i: i32) -> f32 { (*p)[i] += 1; return dot(*p, cross(*p, vec3f(1))) + (*p).zyx.y; }
@compute @workgroup_size(1) fn cs_main() { dst.y = f(&dst, u.x); dst *= 2.0; let p = &h; *p = *p * h.x; (*p)[u.y] = 2.0; dst[Packed.z] = f32(u.y); let q = dst; dst = q * mat3x3f() + vec3f(u) * vec3f(Packed); }
