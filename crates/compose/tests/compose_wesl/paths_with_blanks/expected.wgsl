// package::m

const x = 1.0;
const z = 2.0;

// package::main

fn main() -> f32 { return x + z; }
