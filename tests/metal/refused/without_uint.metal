// mistake in line 8: unknown type name 'uint'
#include <metal_stdlib>

struct Output {
    metal::float4 color [[color(0)]];
};
struct Lamps {
    uint count;
};
fragment Output main_(
  metal::float4 position [[position]]
) {
    return Output { position };
}
