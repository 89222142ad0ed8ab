// package::b

fn f() {}

// package::main

fn main() { f(); }
