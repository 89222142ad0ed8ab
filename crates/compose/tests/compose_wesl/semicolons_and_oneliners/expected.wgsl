// package::m

const x=1;

// package::main

struct A { x: f32 }
struct B { a: A, b: i32, }
const c = x;
fn f() { ; }
