// package::m

const y = 2.0;

// package::main

struct S {
    two: vec2f, // two
    last: f32,
}
fn f(s: S, q: vec2f) -> f32 { return s.last + y; }
