// mistake in line 8: redefinition of 'SCALE'
#include <metal_stdlib>
#include <simd/simd.h>

using metal::uint;

constant float SCALE = 2.0;
constant float SCALE = 3.0;
struct Output {
    metal::float4 color [[color(0)]];
};
fragment Output main_(
  metal::float4 position [[position]]
) {
    return Output { position * SCALE };
}
