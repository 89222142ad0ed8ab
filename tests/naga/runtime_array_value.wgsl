@compute @workgroup_size(1) fn cs_main() { let a = array<f32>(); }
