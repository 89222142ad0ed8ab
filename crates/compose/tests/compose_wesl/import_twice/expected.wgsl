// package::f

fn foo() {}

// package::main

fn main() { foo(); foo(); }
