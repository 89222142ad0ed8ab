// mistake in line 15: no matching member function for call to 'sample'
#include <metal_stdlib>
#include <simd/simd.h>

using metal::uint;

struct Output {
    metal::float4 color [[color(0)]];
};
fragment Output main_(
  metal::texturecube<float, metal::access::sample> map [[texture(0)]]
, metal::sampler map_sampler [[sampler(0)]]
, metal::float4 position [[position]]
) {
    return Output { map.sample(map_sampler, position.xyz, metal::gradient2d(position.xy, position.xy)) };
}
