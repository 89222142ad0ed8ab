// lighting

fn lighting() {}

// package::main

fn main() { lighting(); }
