// package::light

fn foo() -> f32 { return 1.0; }

// package::main

fn light() -> f32 { return foo(); }
fn main() -> f32 { return light(); }
