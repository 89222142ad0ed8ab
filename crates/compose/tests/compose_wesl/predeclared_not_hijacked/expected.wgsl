// package::f

fn clamp01(x: f32) -> f32 { return package_f_min(x); }
fn package_f_min(x: f32) -> f32 { return x; }

// package::main

fn main() -> f32 { return min(1.0, clamp01(2.0)); }
