// older::m

fn plain() {}

// package::main

fn main() { plain(); }
