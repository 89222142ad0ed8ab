#include <metal_stdlib>
#include <simd/simd.h>

using metal::uint;

struct main_Input {
    metal::float4 a [[user(loc0), center_perspective]];
    metal::float4 b [[user(loc1), center_perspective]];
    metal::float4 c [[user(loc2), center_perspective]];
};
struct main_Output {
    metal::float4 to0 [[color(0)]];
    metal::float4 to1 [[color(1)]];
    metal::float4 to2 [[color(2)]];
    metal::float4 to3 [[color(3)]];
};
fragment main_Output main_(
  main_Input varyings [[stage_in]]
) {
    const auto a = varyings.a;
    const auto b = varyings.b;
    const auto c = varyings.c;
    metal::float4 whole = {};
    metal::float4 rest = metal::modf(a, whole);
    metal::int4 exponent = {};
    metal::float4 fraction = metal::frexp(a, exponent);
    int e = {};
    float one = metal::frexp(b.x, e);
    return main_Output { rest, whole, metal::ldexp(fraction, exponent), metal::float4(one, float(e), metal::ldexp(c.x, 3), static_cast<float>(exponent.y)) };
}
