// mistake in line 1: there is no entry point
#include <metal_stdlib>
#include <simd/simd.h>

using metal::uint;

float twice(
    float x
) {
    return x * 2.0;
}
