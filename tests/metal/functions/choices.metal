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
    metal::bool4 below = a < b;
    metal::bool2 pair = metal::bool2(below.x, a.y > 0.0);
    metal::bool3 three = (a.xyz < b.xyz) & !(b.xyz < metal::float3(0.0));
    metal::float4 facts = metal::float4(metal::all(below), metal::any(pair), metal::isnan(a.x / 0.0 * 0.0), metal::isinf(a.x / 0.0));
    metal::float4 counted = static_cast<metal::float4>(below) + metal::float4((a < b).wzyx);
    float single = static_cast<float>((a.xy < b.xy).y);
    metal::bool4 swapped = below.wzyx || metal::bool4(three, single == 1.0);
    return main_Output { metal::select(a, b, below), facts, counted, metal::select(metal::float4(static_cast<metal::float3>(three), single), metal::float4(2.0), swapped) };
}
