@compute @workgroup_size(2) fn main() {}
