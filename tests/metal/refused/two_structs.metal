// mistake in line 12: redefinition of 'Light'
#include <metal_stdlib>
#include <simd/simd.h>

using metal::uint;

struct Light {
    metal::float4 color;
};

// Here it is again.
struct Light {
    float range;
};
struct Output {
    metal::float4 color [[color(0)]];
};
fragment Output main_(
  metal::float4 position [[position]]
) {
    return Output { position };
}
