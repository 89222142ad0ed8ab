// package::m

/// What it returns.
@must_use
fn f() -> f32 { return hidden(); }
fn hidden() -> f32 { return 1.0; }
const limit = 2.0;
const public_name = 3.0;

// package::main

// `private` is a plain name elsewhere.
const private_one = 1;
struct Public { private: f32 }
@must_use fn twice(private: f32) -> f32 { return private; }
fn main() -> f32 {
    let value = Public(f() + twice(limit));
    return value.private + f32(private_one) + public_name;
}
