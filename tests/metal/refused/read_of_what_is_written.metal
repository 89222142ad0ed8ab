// mistake in line 13: this texture is not for reading
#include <metal_stdlib>
#include <simd/simd.h>

using metal::uint;

struct Output {
    metal::float4 color [[color(0)]];
};
kernel void main_(
  metal::texture2d<float, metal::access::write> target [[texture(0)]]
) {
    target.write(target.read(metal::uint2(0u)), metal::uint2(0u));
}
