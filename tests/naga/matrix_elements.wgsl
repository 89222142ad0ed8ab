struct In { a: mat2x3f, b: mat2x4f, c: mat3x2f, d: mat4x2f }
@group(0) @binding(0) var<storage> i: In;
@group(0) @binding(1) var<storage, read_write> o: array<f32>;
@compute @workgroup_size(1) fn main(@builtin(global_invocation_id) g: vec3u) { o[0] = i.a[1].y; o[1] = i.b[1][2]; o[2] = i.c[2].y; o[3] = i.d[g.x][g.y]; }
