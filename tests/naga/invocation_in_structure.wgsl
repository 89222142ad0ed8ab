struct Invocation { @builtin(local_invocation_id) local_id: vec3u, @builtin(workgroup_id) group: vec3u }
var<workgroup> sums: array<f32, 16>;
@group(0) @binding(0) var<storage, read_write> result: array<f32>;
@compute @workgroup_size(16) fn cs_main(at: Invocation) {
    sums[at.local_id.x] += f32(at.group.x);
    workgroupBarrier();
    result[at.local_id.x] = sums[15u - at.local_id.x];
}
