// package::slow

fn go() -> f32 { return 2.0; }

// package::slow::deep

const er = 2.0;

// package::main

fn main() -> f32 { return go() + er; }
