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
};
fragment main_Output main_(
  main_Input varyings [[stage_in]]
) {
    const auto a = varyings.a;
    const auto b = varyings.b;
    const auto c = varyings.c;
    metal::half4 kept = metal::half4(a);
    uint word = as_type<uint>(half2(b.xy));
    return main_Output { metal::float4(kept), metal::float4(float2(as_type<half2>(word)), float(half(c.x)), float(word & 65535u)), metal::float4(metal::half4(b * 0.00001)) };
}
