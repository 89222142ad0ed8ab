// mistake in line 8: no type named 'float5' in namespace 'metal'
#include <metal_stdlib>
#include <simd/simd.h>

using metal::uint;

struct Light {
    metal::float5 color;
};
struct Output {
    metal::float4 color [[color(0)]];
};
fragment Output main_(
  metal::float4 position [[position]]
) {
    return Output { position };
}
