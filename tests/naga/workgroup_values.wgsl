struct S { a: array<vec4f, 2>, b: mat3x3f, c: f32 }
struct T { s: S, d: array<array<u32, 2>, 2> }
var<workgroup> w: array<vec4f, 4>; var<workgroup> s: S; var<workgroup> t: T;
@group(0) @binding(0) var<storage, read_write> r: array<vec4f, 4>;
@group(0) @binding(1) var<uniform> u: S;
@compute @workgroup_size(64) fn main(@builtin(local_invocation_index) i: u32) { w = r; s = u; var k: T; k.s = s; t = k; workgroupBarrier(); let all = w; let v = t; r = all; r[i % 4u] = v.s.a[1] + s.b[1].xyzz + f32(v.d[1][i % 2u]) + workgroupUniformLoad(&s).c; }
