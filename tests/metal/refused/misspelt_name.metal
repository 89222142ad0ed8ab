// mistake in line 13: use of undeclared identifier 'positoin'
#include <metal_stdlib>
#include <simd/simd.h>

using metal::uint;

struct Output {
    metal::float4 color [[color(0)]];
};
fragment Output main_(
  metal::float4 position [[position]]
) {
    metal::float4 moved = positoin + 1.0;
    return Output { moved };
}
