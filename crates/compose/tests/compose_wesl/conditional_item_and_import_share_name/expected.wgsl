// package::m

fn shade() -> f32 { return 2.0; }

// package::main

fn main() -> f32 { return shade(); }
