// package::util

const package_util_bar = 10;
fn package_util_func() {
    let foo = 20;
    let x = foo; /* foo is shadowed. */
    let y = package_util_bar; /* bar is not shadowed. */
}

// package::main

fn main() { package_util_func(); }
