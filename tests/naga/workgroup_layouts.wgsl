struct S { a: f32, b: array<vec3f, 2> }
var<workgroup> w: array<f32, 64>; var<workgroup> s: S; var<workgroup> both: array<vec4f, 4>; var<workgroup> m: array<mat2x2f, 2>;
@group(0) @binding(0) var<storage, read_write> r: array<f32>;
@group(0) @binding(1) var<uniform> u: array<vec4f, 4>;
@compute @workgroup_size(64) fn main(@builtin(local_invocation_index) i: u32) { w[i] = f32(i); both[i % 4u] = u[i % 4u]; s.b[i % 2u].y = 1.0; m[1][0].x = 2.0; workgroupBarrier(); let all = w; r[i] = all[63u - i] + both[i % 3u].x + s.b[1].y + m[1][0].x; }
