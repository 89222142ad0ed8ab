@group(0) @binding(0) var<storage, read_write> result: array<u32>;
@compute @workgroup_size(1) fn cs_main() {
    var one: i32 = 1;
    result[0] = bitcast<u32>(one) + bitcast<u32>(1i);
    result[1] = u32(1i);
}
