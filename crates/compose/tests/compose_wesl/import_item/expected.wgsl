// package::bar

fn foo() {}

// package::main

fn main() { foo(); }
