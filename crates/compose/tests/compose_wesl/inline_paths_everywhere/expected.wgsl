// package::k

const GROUP = 0;
const BINDING = 1;
const COUNT = 4;
const factor = 2.0;
alias F = f32;
struct S { x: F }
fn zero() -> i32 { return 0; }
fn touch() {}

// package::main

@group(GROUP) @binding(BINDING) var<uniform> u: S;
alias A = array<S, COUNT>;
override scale: f32 = factor;
const_assert COUNT > 1;
@compute @workgroup_size(COUNT, 1)
fn main() {
    var list: A;
    var p: ptr<function, S> = &list[COUNT - 1];
    for (var i = zero(); i < COUNT; i += zero() + 1) { touch(); }
    let s = S(factor);
    let v = vec2<F>(1.0, bitcast<F>(1u));
    switch COUNT { case COUNT: { } default: { } }
    (*p).x = u.x + scale + v.x + s.x;
}
