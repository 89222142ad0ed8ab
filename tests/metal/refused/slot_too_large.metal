// mistake in line 12: the attribute `sampler` cannot be given `16`
#include <metal_stdlib>
#include <simd/simd.h>

using metal::uint;

struct Output {
    metal::float4 color [[color(0)]];
};
fragment Output main_(
  metal::texture2d<float, metal::access::sample> map [[texture(0)]]
, metal::sampler map_sampler [[sampler(16)]]
) {
    return Output { map.sample(map_sampler, metal::float2(0.5)) };
}
