// package::a::b

fn go() { stop(); halt(); }

// package::a::c

fn stop() {}

// package::top

fn halt() {}

// package::main

fn main() { go(); }
