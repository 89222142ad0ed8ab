// package::t

alias T = f32;
const N = 2u;

// package::main

const a = array<array<T, N>,N>();
const b: bool = 3>=N;
const c = 8>>N;
fn f(x: array<vec4<T>, N>, y: ptr<function, array<array<T, (N>>1)>, 2>>) -> vec2<T> { return vec2<T>(x[N - 1].x); }
