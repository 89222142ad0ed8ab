// package::f

fn package_f_foo() {}
fn package_f_baz(x: i32) {}

// package::main

fn main() { let foo = 1; package_f_foo(); package_f_baz(2); }
fn other(baz: i32) { package_f_baz(baz); }
