var<workgroup> shared_sum: u32;
@group(0) @binding(0) var<storage, read_write> result: array<u32>;
@compute @workgroup_size(64) fn cs_main(@builtin(local_invocation_index) at: u32) {
    if at < 32u { shared_sum = at; workgroupBarrier(); }
    result[at] = shared_sum;
}
