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
    metal::float4x4 m = metal::float4x4(a, b, c, a.wzyx);
    metal::float2x3 tall = metal::float2x3(a.xyz, b.xyz);
    metal::float3x2 wide = metal::float3x2(a.xy, b.xy, c.xy);
    metal::float3x3 square = metal::float3x3(a.xyz, b.xyz, c.xyz);
    metal::float2x2 small = wide * tall;
    metal::float4x4 product = m * metal::float4x4(metal::float4(1.0, 2.0, 3.0, 4.0), c, b, a);
    metal::float3x3 sum = (square + metal::transpose(square)) * 0.5 - square;
    metal::float4 sizes = metal::float4(metal::determinant(m), metal::determinant(square), metal::determinant(metal::float2x2(a.xy, b.xy)), (-square)[1].z);
    return main_Output { m * c, c * m, product[1], metal::float4(tall * c.xy, (a.xyz * tall).y), metal::float4(small[0], small[1]), metal::float4(sum[2], sum[0][1]), sizes, metal::float4(wide * c.xyz, metal::transpose(wide)[1].yz) };
}
