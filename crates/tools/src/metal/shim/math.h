// Functions of the Metal standard library over numbers, as far as naga's writer of MSL uses them.
//
// Every function is a set of plain overloads, one for each number of components: clang chooses
// among few functions, and a vector of a wrong size has none. `fast` and `precise` are the same.
#pragma once

#include "matrix.h"

// One function of one argument, of two, of three: component by component. A component of an `int3`
// is a `wchar_t`, yet an `int` is an `int`: S is the scalar, E the component.
#define __LL_MAP1(S, E, V, name, f)                                                    \
  inline S name(S a) { return f(a); }                                                  \
  inline V##2 name(V##2 a) { return V##2{E(f(a.x)), E(f(a.y))}; }                      \
  inline V##3 name(V##3 a) { return V##3{E(f(a.x)), E(f(a.y)), E(f(a.z))}; }           \
  inline V##4 name(V##4 a) { return V##4{E(f(a.x)), E(f(a.y)), E(f(a.z)), E(f(a.w))}; }
#define __LL_MAP2(S, E, V, name, f)                                                    \
  inline S name(S a, S b) { return f(a, b); }                                          \
  inline V##2 name(V##2 a, V##2 b) { return V##2{E(f(a.x, b.x)), E(f(a.y, b.y))}; }    \
  inline V##3 name(V##3 a, V##3 b) {                                                   \
    return V##3{E(f(a.x, b.x)), E(f(a.y, b.y)), E(f(a.z, b.z))};                       \
  }                                                                                    \
  inline V##4 name(V##4 a, V##4 b) {                                                   \
    return V##4{E(f(a.x, b.x)), E(f(a.y, b.y)), E(f(a.z, b.z)), E(f(a.w, b.w))};       \
  }
#define __LL_MAP3(S, E, V, name, f)                                                    \
  inline S name(S a, S b, S c) { return f(a, b, c); }                                  \
  inline V##2 name(V##2 a, V##2 b, V##2 c) {                                           \
    return V##2{E(f(a.x, b.x, c.x)), E(f(a.y, b.y, c.y))};                             \
  }                                                                                    \
  inline V##3 name(V##3 a, V##3 b, V##3 c) {                                           \
    return V##3{E(f(a.x, b.x, c.x)), E(f(a.y, b.y, c.y)), E(f(a.z, b.z, c.z))};        \
  }                                                                                    \
  inline V##4 name(V##4 a, V##4 b, V##4 c) {                                           \
    return V##4{E(f(a.x, b.x, c.x)), E(f(a.y, b.y, c.y)), E(f(a.z, b.z, c.z)),         \
                E(f(a.w, b.w, c.w))};                                                  \
  }

namespace __lamplight {

constexpr float infinity = __builtin_inff();

inline float fract(float x) { return __builtin_fminf(x - __builtin_floorf(x), 0x1.fffffep-1f); }
inline float sign(float x) { return x > 0.0f ? 1.0f : x < 0.0f ? -1.0f : x == x ? x : 0.0f; }
inline float step(float edge, float x) { return x < edge ? 0.0f : 1.0f; }
inline float clamp(float x, float low, float high) {
  return __builtin_fminf(__builtin_fmaxf(x, low), high);
}
inline float saturate(float x) { return clamp(x, 0.0f, 1.0f); }
inline float mix(float x, float y, float a) { return x + (y - x) * a; }
inline float smoothstep(float low, float high, float x) {
  const float t = saturate((x - low) / (high - low));
  return t * t * (3.0f - 2.0f * t);
}
inline float rsqrt(float x) { return 1.0f / __builtin_sqrtf(x); }
inline float modf(float x, float& whole) { return __builtin_modff(x, &whole); }
inline half modf(half x, half& whole) {
  float to;
  const half rest = half(__builtin_modff(x, &to));
  whole = half(to);
  return rest;
}
inline float frexp(float x, int& exponent) { return __builtin_frexpf(x, &exponent); }

inline int whole_min(int a, int b) { return a < b ? a : b; }
inline int whole_max(int a, int b) { return a > b ? a : b; }
inline unsigned whole_min(unsigned a, unsigned b) { return a < b ? a : b; }
inline unsigned whole_max(unsigned a, unsigned b) { return a > b ? a : b; }
inline int whole_abs(int a) { return a < 0 ? -a : a; }
inline unsigned whole_abs(unsigned a) { return a; }

inline int popcount(unsigned x) { return __builtin_popcount(x); }
inline int clz(unsigned x) { return x == 0 ? 32 : __builtin_clz(x); }
inline int ctz(unsigned x) { return x == 0 ? 32 : __builtin_ctz(x); }
inline unsigned reverse(unsigned x) { return __builtin_bitreverse32(x); }

/// Zero bits are none; all 32 are shifted in two steps.
inline unsigned ones(unsigned count) { return count >= 32 ? ~0u : (1u << count) - 1u; }
inline unsigned extract(unsigned x, unsigned offset, unsigned count) {
  return offset >= 32 ? 0u : (x >> offset) & ones(count);
}
inline int extract(int x, unsigned offset, unsigned count) {
  if (count == 0 || offset >= 32) return 0;
  const unsigned raised = unsigned(x) << (32 - count - offset);
  return int(raised) >> (32 - count);
}
inline unsigned insert(unsigned base, unsigned bits, unsigned offset, unsigned count) {
  if (count == 0 || offset >= 32) return base;
  const unsigned mask = ones(count) << offset;
  return (base & ~mask) | ((bits << offset) & mask);
}

}  // namespace __lamplight

namespace metal {

#define __LL_FLOAT1(name, f) \
  __LL_MAP1(float, float, float, name, f) __LL_MAP1(half, half, half, name, f)
#define __LL_FLOAT2(name, f) \
  __LL_MAP2(float, float, float, name, f) __LL_MAP2(half, half, half, name, f)
#define __LL_FLOAT3(name, f) \
  __LL_MAP3(float, float, float, name, f) __LL_MAP3(half, half, half, name, f)

__LL_FLOAT1(abs, __builtin_fabsf)
__LL_FLOAT1(acos, __builtin_acosf)
__LL_FLOAT1(acosh, __builtin_acoshf)
__LL_FLOAT1(asin, __builtin_asinf)
__LL_FLOAT1(asinh, __builtin_asinhf)
__LL_FLOAT1(atan, __builtin_atanf)
__LL_FLOAT1(atanh, __builtin_atanhf)
__LL_FLOAT1(ceil, __builtin_ceilf)
__LL_FLOAT1(cos, __builtin_cosf)
__LL_FLOAT1(cosh, __builtin_coshf)
__LL_FLOAT1(exp, __builtin_expf)
__LL_FLOAT1(exp2, __builtin_exp2f)
__LL_FLOAT1(floor, __builtin_floorf)
__LL_FLOAT1(fract, __lamplight::fract)
__LL_FLOAT1(log, __builtin_logf)
__LL_FLOAT1(log2, __builtin_log2f)
__LL_FLOAT1(rint, __builtin_rintf)
__LL_FLOAT1(round, __builtin_roundf)
__LL_FLOAT1(rsqrt, __lamplight::rsqrt)
__LL_FLOAT1(saturate, __lamplight::saturate)
__LL_FLOAT1(sign, __lamplight::sign)
__LL_FLOAT1(sin, __builtin_sinf)
__LL_FLOAT1(sinh, __builtin_sinhf)
__LL_FLOAT1(sqrt, __builtin_sqrtf)
__LL_FLOAT1(tan, __builtin_tanf)
__LL_FLOAT1(tanh, __builtin_tanhf)
__LL_FLOAT1(trunc, __builtin_truncf)
__LL_FLOAT2(atan2, __builtin_atan2f)
__LL_FLOAT2(fmod, __builtin_fmodf)
__LL_FLOAT2(max, __builtin_fmaxf)
__LL_FLOAT2(min, __builtin_fminf)
__LL_FLOAT2(pow, __builtin_powf)
__LL_FLOAT2(step, __lamplight::step)
__LL_FLOAT3(clamp, __lamplight::clamp)
__LL_FLOAT3(fma, __builtin_fmaf)
__LL_FLOAT3(mix, __lamplight::mix)
__LL_FLOAT3(smoothstep, __lamplight::smoothstep)

#define __LL_INT1(name, f) \
  __LL_MAP1(int, wchar_t, int, name, f) __LL_MAP1(uint, uint, uint, name, f)
#define __LL_INT2(name, f) \
  __LL_MAP2(int, wchar_t, int, name, f) __LL_MAP2(uint, uint, uint, name, f)
__LL_INT1(abs, __lamplight::whole_abs)
__LL_INT1(clz, __lamplight::clz)
__LL_INT1(ctz, __lamplight::ctz)
__LL_INT1(popcount, __lamplight::popcount)
__LL_INT1(reverse_bits, __lamplight::reverse)
__LL_INT2(max, __lamplight::whole_max)
__LL_INT2(min, __lamplight::whole_min)

#define __LL_CLAMP(T) \
  inline T clamp(T x, T low, T high) { return min(max(x, low), high); }
__LL_CLAMP(int)
__LL_CLAMP(int2)
__LL_CLAMP(int3)
__LL_CLAMP(int4)
__LL_CLAMP(uint)
__LL_CLAMP(uint2)
__LL_CLAMP(uint3)
__LL_CLAMP(uint4)

// Parts of numbers: the second result goes to a variable.
#define __LL_SPLIT(F, I, S, name, ...)                                                   \
  inline F name(F x, I& to) {                                                            \
    F rest = {};                                                                         \
    for (int i = 0; i < __lamplight::size_of<F>; ++i) {                                  \
      S part;                                                                            \
      rest[i] = __lamplight::name(x[i], part);                                           \
      to[i] = part;                                                                      \
    }                                                                                    \
    return rest;                                                                         \
  }
inline float modf(float x, float& whole) { return __lamplight::modf(x, whole); }
__LL_SPLIT(float2, float2, float, modf)
__LL_SPLIT(float3, float3, float, modf)
__LL_SPLIT(float4, float4, float, modf)
inline half modf(half x, half& whole) { return __lamplight::modf(x, whole); }
__LL_SPLIT(half2, half2, half, modf)
__LL_SPLIT(half3, half3, half, modf)
__LL_SPLIT(half4, half4, half, modf)
inline float frexp(float x, int& exponent) { return __lamplight::frexp(x, exponent); }
__LL_SPLIT(float2, int2, int, frexp)
__LL_SPLIT(float3, int3, int, frexp)
__LL_SPLIT(float4, int4, int, frexp)
inline float ldexp(float x, int e) { return __builtin_ldexpf(x, e); }
inline float2 ldexp(float2 x, int2 e) { return float2{ldexp(x.x, e.x), ldexp(x.y, e.y)}; }
inline float3 ldexp(float3 x, int3 e) {
  return float3{ldexp(x.x, e.x), ldexp(x.y, e.y), ldexp(x.z, e.z)};
}
inline float4 ldexp(float4 x, int4 e) {
  return float4{ldexp(x.x, e.x), ldexp(x.y, e.y), ldexp(x.z, e.z), ldexp(x.w, e.w)};
}

// Geometry.
inline float dot(float2 a, float2 b) { return a.x * b.x + a.y * b.y; }
inline float dot(float3 a, float3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline float dot(float4 a, float4 b) { return a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w; }
inline float3 cross(float3 a, float3 b) { return a.yzx * b.zxy - a.zxy * b.yzx; }
#define __LL_GEOMETRY(V)                                                               \
  inline float length(V a) { return __builtin_sqrtf(dot(a, a)); }                      \
  inline float distance(V a, V b) { return length(a - b); }                            \
  inline V normalize(V a) { return a / length(a); }                                    \
  inline V faceforward(V n, V i, V reference) { return dot(reference, i) < 0.0f ? n : -n; } \
  inline V reflect(V i, V n) { return i - 2.0f * dot(n, i) * n; }                      \
  inline V refract(V i, V n, float eta) {                                              \
    const float c = dot(n, i), k = 1.0f - eta * eta * (1.0f - c * c);                  \
    return k < 0.0f ? V{} : eta * i - (eta * c + __builtin_sqrtf(k)) * n;              \
  }
__LL_GEOMETRY(float2)
__LL_GEOMETRY(float3)
__LL_GEOMETRY(float4)

#define __LL_HALF_GEOMETRY(n)                                                            \
  inline half dot(half##n a, half##n b) {                                                \
    float sum = 0.0f;                                                                    \
    for (int i = 0; i < n; ++i) sum += float(a[i]) * float(b[i]);                        \
    return half(sum);                                                                    \
  }                                                                                      \
  inline half length(half##n a) { return half(__builtin_sqrtf(float(dot(a, a)))); }      \
  inline half distance(half##n a, half##n b) { return length(a - b); }                   \
  inline half##n normalize(half##n a) { return a / length(a); }                          \
  inline half##n reflect(half##n i, half##n m) { return i - half(2.0f * float(dot(m, i))) * m; }
__LL_HALF_GEOMETRY(2)
__LL_HALF_GEOMETRY(3)
__LL_HALF_GEOMETRY(4)
inline half3 cross(half3 a, half3 b) { return a.yzx * b.zxy - a.zxy * b.yzx; }

// Choices and tests. `select` takes its second value where the condition holds.
#define __LL_SELECT1(T) \
  inline T select(T a, T b, bool c) { return c ? b : a; }
#define __LL_SELECT(V, n)                                             \
  inline V##n select(V##n a, V##n b, bool##n c) {                     \
    V##n to = a;                                                      \
    for (int i = 0; i < n; ++i)                                       \
      if (c[i]) to[i] = b[i];                                         \
    return to;                                                        \
  }
#define __LL_SELECTS(S, V) \
  __LL_SELECT1(S) __LL_SELECT(V, 2) __LL_SELECT(V, 3) __LL_SELECT(V, 4)
__LL_SELECTS(float, float)
__LL_SELECTS(half, half)
__LL_SELECTS(int, int)
__LL_SELECTS(uint, uint)
__LL_SELECTS(bool, bool)

inline bool all(bool v) { return v; }
inline bool all(bool2 v) { return v.x && v.y; }
inline bool all(bool3 v) { return v.x && v.y && v.z; }
inline bool all(bool4 v) { return v.x && v.y && v.z && v.w; }
inline bool any(bool v) { return v; }
inline bool any(bool2 v) { return v.x || v.y; }
inline bool any(bool3 v) { return v.x || v.y || v.z; }
inline bool any(bool4 v) { return v.x || v.y || v.z || v.w; }
inline bool isnan(float v) { return __builtin_isnan(v); }
inline bool2 isnan(float2 v) { return v != v; }
inline bool3 isnan(float3 v) { return v != v; }
inline bool4 isnan(float4 v) { return v != v; }
inline bool isinf(float v) { return __builtin_isinf(v); }
inline bool2 isinf(float2 v) { return abs(v) == __lamplight::infinity; }
inline bool3 isinf(float3 v) { return abs(v) == __lamplight::infinity; }
inline bool4 isinf(float4 v) { return abs(v) == __lamplight::infinity; }

// Bit fields.
#define __LL_FIELDS(S, V, n)                                                        \
  inline V##n extract_bits(V##n v, uint offset, uint count) {                       \
    V##n to = {};                                                                   \
    for (int i = 0; i < n; ++i) to[i] = __lamplight::extract(S(v[i]), offset, count); \
    return to;                                                                      \
  }                                                                                 \
  inline V##n insert_bits(V##n base, V##n v, uint offset, uint count) {             \
    V##n to = {};                                                                   \
    for (int i = 0; i < n; ++i)                                                     \
      to[i] = __lamplight::insert(base[i], v[i], offset, count);                    \
    return to;                                                                      \
  }
#define __LL_FIELDS1(S)                                                             \
  inline S extract_bits(S v, uint offset, uint count) {                             \
    return __lamplight::extract(v, offset, count);                                  \
  }                                                                                 \
  inline S insert_bits(S base, S v, uint offset, uint count) {                      \
    return __lamplight::insert(base, v, offset, count);                             \
  }
__LL_FIELDS1(int)
__LL_FIELDS(int, int, 2)
__LL_FIELDS(int, int, 3)
__LL_FIELDS(int, int, 4)
__LL_FIELDS1(uint)
__LL_FIELDS(uint, uint, 2)
__LL_FIELDS(uint, uint, 3)
__LL_FIELDS(uint, uint, 4)

// Numbers packed into words: rounded once, from the exact product.
#define __LL_PACKED(V, name, low, most, bits, n)                                    \
  inline uint name(V v) {                                                           \
    uint to = 0;                                                                    \
    for (int i = 0; i < n; ++i) {                                                   \
      const double scaled = double(clamp(v[i], low, 1.0f)) * double(most);          \
      to |= (uint(int(__builtin_rint(scaled))) & ((1u << bits) - 1u)) << (bits * i); \
    }                                                                               \
    return to;                                                                      \
  }
__LL_PACKED(float4, pack_float_to_unorm4x8, 0.0f, 255.0f, 8, 4)
__LL_PACKED(float4, pack_float_to_snorm4x8, -1.0f, 127.0f, 8, 4)
__LL_PACKED(float2, pack_float_to_unorm2x16, 0.0f, 65535.0f, 16, 2)
__LL_PACKED(float2, pack_float_to_snorm2x16, -1.0f, 32767.0f, 16, 2)
inline float4 unpack_unorm4x8_to_float(uint v) {
  return float4{float(v & 255), float(v >> 8 & 255), float(v >> 16 & 255), float(v >> 24)} /
         255.0f;
}
inline float4 unpack_snorm4x8_to_float(uint v) {
  const float4 parts{float(int8_t(v)), float(int8_t(v >> 8)), float(int8_t(v >> 16)),
                     float(int8_t(v >> 24))};
  return max(parts / 127.0f, -1.0f);
}
inline float2 unpack_unorm2x16_to_float(uint v) {
  return float2{float(v & 65535), float(v >> 16)} / 65535.0f;
}
inline float2 unpack_snorm2x16_to_float(uint v) {
  return max(float2{float(int16_t(v)), float(int16_t(v >> 16))} / 32767.0f, -1.0f);
}

namespace fast = ::metal;
namespace precise = ::metal;

}  // namespace metal

// What clang calls to convert numbers of 16 bits where the processor does not.
extern "C" __attribute__((weak)) float __gnu_h2f_ieee(unsigned short bits) {
  const unsigned sign = (bits & 0x8000u) << 16, rest = bits & 0x7fffu;
  if (rest >= 0x7c00u) return __builtin_bit_cast(float, sign | 0x7f800000u | rest << 13);
  // Scaled by a power of two, which is exact for subnormal numbers too.
  const float scaled = __builtin_bit_cast(float, rest << 13) * 0x1p+112f;
  return __builtin_bit_cast(float, sign | __builtin_bit_cast(unsigned, scaled));
}

extern "C" __attribute__((weak)) unsigned short __gnu_f2h_ieee(float value) {
  const unsigned word = __builtin_bit_cast(unsigned, value), magnitude = word & 0x7fffffffu;
  const unsigned short sign = (word >> 16) & 0x8000u;
  if (magnitude > 0x7f800000u) {
    return sign | 0x7e00u;
  } else if (magnitude >= 0x477ff000u) {
    // What rounds beyond the largest half.
    return sign | 0x7c00u;
  } else if (magnitude < 0x38800000u) {
    // Subnormal: adding this number leaves the rounded fraction in the last bits.
    const float placed = __builtin_bit_cast(float, magnitude) + 0x1p-1f;
    return sign | (__builtin_bit_cast(unsigned, placed) - 0x3f000000u);
  } else {
    const unsigned odd = magnitude >> 13 & 1;
    return sign | ((magnitude - 0x38000000u + 0xfffu + odd) >> 13);
  }
}
