override a: f32 = 2.0; @id(7) override b: u32; override c = b * 2u; override flag: bool = true;
const k = 3;
@fragment fn fs_main() -> @location(0) vec4f { if flag { return vec4f(a * k, f32(b), f32(c + u32(k)), -a); } return vec4f(pow(a, 2.0)); }
