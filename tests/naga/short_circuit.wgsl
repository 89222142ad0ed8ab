var<private> n: i32 = 1;
fn side(k: i32) -> bool { n += k; return n > 3; }
@fragment fn fs_main() -> @location(0) vec4f { let a = side(1) && side(5) || side(10); let b = (n > 3) || side(100); while side(1) && n < 30 { if side(2) || n == 11 { continue; } } return vec4f(f32(n), select(0.0, 1.0, a), select(0.0, 1.0, b), 0); }
