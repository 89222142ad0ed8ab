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
    metal::uint4 to4 [[color(4)]];
    metal::uint4 to5 [[color(5)]];
    metal::uint4 to6 [[color(6)]];
    metal::uint4 to7 [[color(7)]];
};
fragment main_Output main_(
  main_Input varyings [[stage_in]]
) {
    const auto a = varyings.a;
    const auto b = varyings.b;
    const auto c = varyings.c;
    metal::int4 x = as_type<metal::int4>(a);
    uint offset = b.x & 31u;
    uint count = metal::min(b.y & 63u, 32u - offset);
    return main_Output { metal::popcount(a), metal::clz(a), metal::ctz(a), metal::reverse_bits(a), metal::extract_bits(a, offset, count), as_type<metal::uint4>(metal::extract_bits(x, offset, count)), metal::insert_bits(a, c, offset, count), metal::uint4(as_type<uint>(metal::reverse_bits(x.x)), metal::popcount(x.y), metal::extract_bits(a.z, 8u, 8u), metal::insert_bits(a.w, c.w, 0u, 32u)) };
}
