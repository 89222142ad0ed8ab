struct S { a: u32, b: vec3u, c: i32 }
var<private> x: S = S(0u, vec3u(0u, 1u, 2u), 3);
@fragment fn main() -> @location(0) vec4f { x.a += 1; return vec4f(vec3f(x.b), f32(x.c + i32(x.a))); }
