// mistake in line 12: redefinition of 'twice'
#include <metal_stdlib>
#include <simd/simd.h>

using metal::uint;

float twice(
    float x
) {
    return x * 2.0;
}
float twice(
    float x
) {
    return x + x;
}
struct Output {
    metal::float4 color [[color(0)]];
};
fragment Output main_(
  metal::float4 position [[position]]
) {
    return Output { position * twice(1.0) };
}
