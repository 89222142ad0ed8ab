const lowest: i32 = -1 * i32(-2147483648);
const product = dot(vec2i(65536), vec2i(65536));
const_assert lowest == -2147483648;
const_assert product == 0;
@fragment fn fs_main() -> @location(0) vec4f { return vec4f(f32(lowest), f32(product), 0.0, 1.0); }
