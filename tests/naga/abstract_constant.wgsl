const one = 1;
const_assert one == 1.0;
const big = one * 3.5;
@fragment fn fs_main() -> @location(0) vec4f { return vec4f(big * one); }
