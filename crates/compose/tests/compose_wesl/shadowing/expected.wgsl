// package::n

const a = 1.0;
const b = 2.0;
const c = 3.0;
const d = 4;
const e = 5.0;

// package::main

struct S { a: f32, b: f32 }
fn params(a: f32) -> f32 { return a + b; }
fn locals() -> f32 {
    let x = b;
    let b = b;
    { let a = 1.0; var y = a + c; y += 1.0; }
    for (var d = 0; d < 3; d++) { let z = d; }
    let s = S(a, f32(d));
    return s.a + s.b + b + x;
}
fn after() -> f32 { if a > 0.0 { let e = a; return e; } else { let c = e; return c; } }
@fragment fn main(@builtin(position) e: vec4f, @location(0) @interpolate(flat) c: i32) -> @location(0) vec4f {
    return e * params(1.0) * locals() * after() * f32(c);
}
