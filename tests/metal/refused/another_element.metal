// mistake in line 13: cannot initialize a variable of type 'metal::int4' (vector of 4 'int' values)
#include <metal_stdlib>
#include <simd/simd.h>

using metal::uint;

struct Output {
    metal::float4 color [[color(0)]];
};
fragment Output main_(
  metal::float4 position [[position]]
) {
    metal::int4 whole = position < 2.0;
    return Output { static_cast<metal::float4>(whole) };
}
