// package::a

fn package_a_f_2() {}

// package::main

fn f() { let package_a_f = 1; package_a_f_2(); }
fn main() { f(); }
