@group(0) @binding(0) var<storage, read_write> result: i32;
@compute @workgroup_size(1) fn cs_main() { var zero = dot(vec2<i32>(), vec2<i32>()); result = zero; }
