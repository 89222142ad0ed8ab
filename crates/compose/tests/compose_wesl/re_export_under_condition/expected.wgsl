// package::b

fn g() {}

// package::main

fn main() { g(); }
