fn f(p: ptr<function, f32>) -> ptr<function, f32> { return p; }
@fragment fn m() -> @location(0) vec4f { var x = 1f; let q = f(&x); *q = 3; return vec4f(x); }
