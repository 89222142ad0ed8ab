// package::foo

// included
const_assert 1 > 0;
fn bar() {}

// package::main

fn main() { bar(); }
