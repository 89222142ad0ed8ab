// mistake in line 14: no member named 'sample_compare'
#include <metal_stdlib>
#include <simd/simd.h>

using metal::uint;

struct Output {
    metal::float4 color [[color(0)]];
};
fragment Output main_(
  metal::texture2d<float, metal::access::sample> map [[texture(0)]]
, metal::sampler map_sampler [[sampler(0)]]
) {
    return Output { metal::float4(map.sample_compare(map_sampler, metal::float2(0.5), 0.5)) };
}
