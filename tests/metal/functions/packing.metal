#include <metal_stdlib>
#include <simd/simd.h>

using metal::uint;

struct main_Input {
    metal::uint4 a [[user(loc0), flat]];
    metal::uint4 b [[user(loc1), flat]];
    metal::uint4 c [[user(loc2), flat]];
};
struct main_Output {
    metal::uint4 to0 [[color(0)]];
    metal::uint4 to1 [[color(1)]];
    metal::uint4 to2 [[color(2)]];
    metal::uint4 to3 [[color(3)]];
};
fragment main_Output main_(
  main_Input varyings [[stage_in]]
) {
    const auto a = varyings.a;
    const auto b = varyings.b;
    const auto c = varyings.c;
    metal::float4 numbers = metal::float4(metal::int4(a >> 8u)) / 8388608.0 - 1.0;
    uint bytes = (uint4(a.x, a.x >> 8, a.x >> 16, a.x >> 24) << 24 >> 24).y;
    int whole = (int4(a.x, a.x >> 8, a.x >> 16, a.x >> 24) << 24 >> 24).z;
    return main_Output { metal::uint4(metal::pack_float_to_snorm4x8(numbers), metal::pack_float_to_unorm4x8(numbers), metal::pack_float_to_snorm2x16(numbers.xy), metal::pack_float_to_unorm2x16(numbers.zw)), as_type<metal::uint4>(metal::unpack_snorm4x8_to_float(b.x)), as_type<metal::uint4>(metal::unpack_unorm4x8_to_float(b.y)), metal::uint4(bytes, whole, as_type<uint>(metal::unpack_snorm2x16_to_float(b.z).y), as_type<uint>(metal::unpack_unorm2x16_to_float(b.w).x)) };
}
