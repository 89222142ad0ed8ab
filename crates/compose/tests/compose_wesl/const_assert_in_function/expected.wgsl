// package::m

const n = 2;
fn check() { const_assert n > 1; }

// package::main

fn main() { check(); }
