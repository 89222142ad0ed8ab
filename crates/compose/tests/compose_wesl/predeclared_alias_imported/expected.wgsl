// package::f

struct A { x: u32 }
alias f32 = A;
fn foo(a: f32) {}

// package::main

fn main() { var s: f32; foo(s); }
