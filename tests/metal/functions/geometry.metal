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
    metal::float3 n = metal::normalize(b.xyz);
    metal::float3 i = metal::normalize(a.xyz);
    metal::float4 sizes = metal::float4(metal::dot(a, b), metal::length(a.xyz), metal::distance(a.xy, b.xy), metal::dot(a.xy, c.zw));
    return main_Output { sizes, metal::float4(metal::cross(a.xyz, b.xyz), metal::dot(a.xyz, b.xyz)), metal::normalize(a), metal::float4(metal::reflect(i, n), metal::length(b)), metal::float4(metal::refract(i, n, 0.7), metal::distance(a, b)), metal::float4(metal::faceforward(a.xyz, i, n), metal::fmod(a.x, 0.75)), metal::fma(a, b, c), metal::float4(metal::normalize(a.xy), metal::refract(metal::normalize(a.xy), metal::normalize(b.xy), 1.5)) };
}
