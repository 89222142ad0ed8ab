// package::both

fn g() { k(); }
fn k() {}

// package::high

fn f() { h(); }
fn h() {}

// package::main

fn main() { f(); g(); }
