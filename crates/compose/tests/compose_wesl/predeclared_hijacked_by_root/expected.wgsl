// package::f

fn low() -> f32 { return max(1.0, 2.0); }

// package::main

fn package_main_max(a: f32) -> f32 { return a; }
fn main() -> f32 { return package_main_max(low()); }
