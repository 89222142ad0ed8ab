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
    metal::int4 y = as_type<metal::int4>(b);
    metal::uint4 widths = metal::uint4(metal::min(x.x, y.x), metal::max(a.y, b.y), metal::abs(x.z), metal::clamp(x.w, -5, 5));
    metal::int4 picked = metal::select(x, y, x < y);
    metal::uint4 several = metal::uint4(a.x > b.x, x.y > y.y, metal::select(a.z, b.z, a.z == b.z), metal::select(31 - metal::clz(metal::select(x.w, ~x.w, x.w < 0)), int(-1), x.w == 0 || x.w == -1));
    return main_Output { a + b, a * b - c, as_type<metal::uint4>(x >> (b & 31u)), a << (b & 31u), (a & b) ^ (~c | 5u), as_type<metal::uint4>(picked), widths, several };
}
