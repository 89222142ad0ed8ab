@compute @workgroup_size(N) fn main() {}
/* why */ @compute @workgroup_size(1)
fn second() {}
const N = 2;
