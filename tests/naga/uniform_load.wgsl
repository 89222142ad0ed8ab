struct S { a: u32, b: vec3f, c: array<f32, 3> }
var<workgroup> s: S;
var<workgroup> flag: bool;
var<workgroup> count: atomic<u32>;
@group(0) @binding(0) var<storage, read_write> result: array<f32>;
@compute @workgroup_size(4) fn cs_main(@builtin(local_invocation_index) i: u32) {
    if i == 0u { s.a = 2u; s.b = vec3f(1); s.c[2] = 4.0; flag = true; atomicStore(&count, 3u); }
    let all = workgroupUniformLoad(&s);
    let f = workgroupUniformLoad(&flag);
    let c = workgroupUniformLoad(&count);
    result[i] = all.b.y + all.c[2] + f32(c);
    if f { workgroupBarrier(); }
}
