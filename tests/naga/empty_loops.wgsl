@compute @workgroup_size(1) fn main() { for (var i = 0; i < 4; i++) { } var k = 0; while k < 3 { k++; } loop { break; } }
