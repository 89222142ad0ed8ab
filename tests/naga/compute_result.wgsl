@compute @workgroup_size(1) fn main() -> @location(0) u32 { return 0; }
