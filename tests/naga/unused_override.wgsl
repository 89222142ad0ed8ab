override a: u32; override b = 10u / a; override c: i32 = 3;
@fragment fn main() -> @location(0) vec4f { return vec4f(f32(c)); }
