// package::utils

fn saturate(x: f32) -> f32 { return x; }

// package::main

fn main() -> f32 { return saturate(2.0) + sin(1.0); }
