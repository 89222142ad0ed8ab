@fragment fn main() -> @location(0) vec4f { var a = 0.0; let b = a; a = 1.0; let c = a; a = 2.0; return vec4f(a, b, c, 1); }
