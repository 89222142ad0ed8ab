override n: u32 = 4; override m: u32 = 4;
var<workgroup> v: array<u32, n>; var<workgroup> w: array<u32, m>; var<workgroup> x: array<u32, n>; var<workgroup> y: array<u32, 4>;
@compute @workgroup_size(1) fn main() { v[0] = 1; w[1] = v[0]; x[2] = w[1]; y[0] = x[2]; }
