// mistake in line 8: there is no attribute `colour`
#include <metal_stdlib>
#include <simd/simd.h>

using metal::uint;

struct Output {
    metal::float4 color [[colour(0)]];
};
fragment Output main_(
  metal::float4 position [[position]]
) {
    return Output { position };
}
