// package::math

const half = 0.5;

// package::math::safe

fn recip(x: f32) -> f32 { return 1.0 / x; }

// package::main

fn main() -> f32 { return recip(2.0) + recip(4.0) + half; }
