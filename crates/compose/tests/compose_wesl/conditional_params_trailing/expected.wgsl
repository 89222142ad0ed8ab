fn f(a: f32, b: f32, ) {}
fn g(a: f32,
     c: f32) {}
fn main() { f(1.0, 2.0); }
