// package::more

fn g() {}

// package::main

fn f() { g(); }
fn sin() { f(); }
