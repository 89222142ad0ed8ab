@group(0) @binding(0) var<storage, read_write> result: vec3<u32>;
@compute @workgroup_size(1) fn cs_main() { result = vec3<u32>(1, 2, 3); }
