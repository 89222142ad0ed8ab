// package::m

fn one() {}
fn two() { three(); }

// package::n

fn three() {}

// package::main

fn a() { one(); }
fn b() {}
