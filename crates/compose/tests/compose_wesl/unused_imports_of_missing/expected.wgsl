// package::ok

fn y() {}

// package::main

fn main() { y(); }
