override n: u32 = 4;
var<workgroup> w: array<vec3f, n * 2>;
@group(0) @binding(0) var<storage, read_write> r: array<f32>;
@compute @workgroup_size(n) fn cs_main(@builtin(local_invocation_index) i: u32) { w[i] = vec3f(f32(i)); workgroupBarrier(); r[i] = w[(i + 1u) % n].y; }
