// mistake in line 13: use of undeclared identifier 'sinf'
#include <metal_stdlib>
#include <simd/simd.h>

using metal::uint;

struct Output {
    metal::float4 color [[color(0)]];
};
fragment Output main_(
  metal::float4 position [[position]]
) {
    return Output { position * sinf(position.x) };
}
