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
struct Kept {
    metal::packed_float3 direction;
    float share;
    metal::float3 up;
};
struct List {
    metal::float2 inner[3];
};
constant List LIST = List {{metal::float2(1.0, 2.0), metal::float2(3.0), metal::float2(5.0, 6.0)}};
fragment main_Output main_(
  main_Input varyings [[stage_in]]
) {
    const auto a = varyings.a;
    const auto b = varyings.b;
    const auto c = varyings.c;
    Kept kept = Kept {a.xyz, b.x, c.xyz};
    kept.direction[1] = kept.direction[1] + kept.share;
    metal::float3 scaled = kept.direction * 2.0 + kept.up * kept.direction - kept.direction / kept.up;
    metal::float4 spread = metal::float4(metal::float2(a.x), metal::float2(b.yz));
    spread.yw = spread.wy;
    metal::int3 whole = static_cast<metal::int3>(metal::clamp(a.xyz * 8.0, -100.0, 100.0));
    metal::uint3 words = as_type<metal::uint3>(whole);
    int index = metal::max(whole.x, 1) - metal::max(whole.x, 1) + 2;
    metal::float3 moved = metal::float3(kept.direction);
    return main_Output { metal::float4(scaled, metal::dot(kept.direction, kept.up)), spread, metal::float4(static_cast<metal::float3>(whole), 1), metal::float4(static_cast<metal::float3>(as_type<metal::int3>(words - 3u)), LIST.inner[index].y), metal::float4(a.x, b.xy, c.z), metal::float4(moved.zyx, moved[1]) };
}
