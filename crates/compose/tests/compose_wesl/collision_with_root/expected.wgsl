// package::f

fn foo() { package_f_clash(0); package_f_clash(1); }
fn package_f_clash(a: i32) {}

// package::main

fn main() { foo(); }
fn clash() {}
