// a::x

fn f() { g(); h(); }

// a::z

fn h() {}

// b::y

fn g() {}

// package::main

fn main() { f(); }
