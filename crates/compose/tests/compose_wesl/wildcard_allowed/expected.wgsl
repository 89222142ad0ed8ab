// lib::m

fn f() {}

// package::main

fn main() { f(); }
