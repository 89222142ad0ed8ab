enable f16;
override o: f16 = 2h;
override p: f16 = o * 2h;
@fragment fn fs_main() -> @location(0) vec4f { return vec4f(f32(max(o, p))); }
