// mistake in line 8: the attribute `buffer` does not belong here
#include <metal_stdlib>
#include <simd/simd.h>

using metal::uint;

struct Output {
    metal::float4 color [[buffer(0)]];
};
fragment Output main_(
  metal::float4 position [[position]]
) {
    return Output { position };
}
