// package::util

const package_util_foo = 10;
const package_util_bar = 10;
fn package_util_func() {
    let foo = 20;
    let x = foo;
    let y = package_util_bar;
}

// package::main

fn main() { package_util_func(); }
