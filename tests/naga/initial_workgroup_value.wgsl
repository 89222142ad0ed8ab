var<workgroup> a: u32 = 3u;
@compute @workgroup_size(1) fn cs_main() { a += 1u; }
