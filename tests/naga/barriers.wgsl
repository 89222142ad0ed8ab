var<workgroup> a: array<u32, 4>;
@group(0) @binding(0) var<storage, read_write> r: array<u32>;
@compute @workgroup_size(4) fn cs_main(@builtin(local_invocation_index) i: u32) { a[i] = i * i; let before = a[i]; workgroupBarrier(); let after = a[3u - i]; workgroupBarrier(); a[i] = before + after; workgroupBarrier(); r[i] = a[(i + 1u) % 4u]; }
