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
    metal::float4 to6 [[color(6)]];
    metal::float4 to7 [[color(7)]];
};
fragment main_Output main_(
  main_Input varyings [[stage_in]]
) {
    const auto a = varyings.a;
    const auto b = varyings.b;
    const auto c = varyings.c;
    metal::float4 sizes = metal::float4(metal::min(a.x, b.x), metal::max(a.xy, b.xy).y, metal::clamp(a.xyz, -0.5, 0.5).z, metal::saturate(a.w));
    return main_Output { metal::min(a, b), metal::max(a, b), metal::clamp(a, -metal::abs(b), metal::abs(c)), metal::saturate(a), metal::step(a, b), metal::smoothstep(-1.0, metal::abs(b) + 0.5, a), metal::mix(a, b, c.x), sizes };
}
