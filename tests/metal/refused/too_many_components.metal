// mistake in line 13: a vector takes as many components as it has
#include <metal_stdlib>
#include <simd/simd.h>

using metal::uint;

struct Output {
    metal::float4 color [[color(0)]];
};
fragment Output main_(
  metal::float4 position [[position]]
) {
    return Output { metal::float4(position.xyz, 1.0, 1.0) };
}
