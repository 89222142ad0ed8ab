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
    metal::float4 to4 [[color(4)]];
    metal::float4 to5 [[color(5)]];
};
fragment main_Output main_(
  main_Input varyings [[stage_in]]
) {
    const auto a = varyings.a;
    const auto b = varyings.b;
    const auto c = varyings.c;
    return main_Output { metal::sinh(a), metal::cosh(a), metal::tanh(a), metal::asinh(a), metal::acosh(metal::abs(a) + 1.5), metal::atanh(a * 0.25) };
}
