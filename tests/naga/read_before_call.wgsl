var<private> n: i32 = 1;
fn side(k: i32) -> i32 { n = n * 3 + k; return n; }
@fragment fn fs_main() -> @location(0) vec4f { let a = n + side(1) * n; let b = side(2) - side(1); var z = array(side(1), n, side(2)); return vec4f(f32(a), f32(b), f32(z[0] - z[1]), f32(z[2])); }
