// mistake in line 13: expected ';'
#include <metal_stdlib>
#include <simd/simd.h>

using metal::uint;

struct Output {
    metal::float4 color [[color(0)]];
};
fragment Output main_(
  metal::float4 position [[position]]
) {
    metal::float3 half_way = position.xyz * 0.5
    return Output { metal::float4(half_way, 1.0) };
}
