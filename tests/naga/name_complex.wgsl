struct complex { re: f32, im: f32 }
fn mul(a: complex, b: complex) -> complex { return complex(a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re); }
@fragment fn main(@location(0) c: vec4f) -> @location(0) vec4f { let r = mul(complex(c.x, c.y), complex(c.z, c.w)); return vec4f(r.re, r.im, 0, 1); }
