struct Inner { counts: array<atomic<i32>, 2> }
@group(0) @binding(0) var<storage, read_write> inner: Inner;
@compute @workgroup_size(1) fn cs_main() { let copied = inner; }
