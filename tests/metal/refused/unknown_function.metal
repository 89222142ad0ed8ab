// mistake in line 13: no member named 'inversesqrt' in namespace 'metal'
#include <metal_stdlib>
#include <simd/simd.h>

using metal::uint;

struct Output {
    metal::float4 color [[color(0)]];
};
fragment Output main_(
  metal::float4 position [[position]]
) {
    return Output { metal::inversesqrt(position) };
}
