// dep

fn one() {}

// package::a

fn f() { shared_helper(); shared_helper(); one(); one(); }

// package::lib

fn main() { f(); }
fn shared_helper() {}
