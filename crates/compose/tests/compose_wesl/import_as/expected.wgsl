// package::file

fn foo() { /* body */ }

// package::main

fn main() { foo(); }
