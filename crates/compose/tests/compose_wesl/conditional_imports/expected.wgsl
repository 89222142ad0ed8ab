// package::accel

fn none() -> f32 { return 3.0; }

// package::main

fn main() -> f32 { return none(); }
