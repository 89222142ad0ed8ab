// mistake in line 17: cannot assign to variable 'lamps'
#include <metal_stdlib>
#include <simd/simd.h>

using metal::uint;

struct Lamps {
    uint count;
};
struct Output {
    metal::float4 color [[color(0)]];
};
fragment Output main_(
  metal::float4 position [[position]]
, constant Lamps& lamps [[buffer(0)]]
) {
    lamps.count = 1u;
    return Output { position };
}
