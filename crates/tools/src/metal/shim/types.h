// Scalars and vectors of the Metal Shading Language, as types of clang.
//
// A vector of numbers is clang's own `ext_vector_type`: it has Metal's size, alignment, operators
// and swizzles. Two things need care:
// - clang gives a comparison of vectors as a vector of `int`, each component 0 or -1: a `mask`.
//   So that a mask is no `int3`, components of an `int3` are of type `wchar_t`: the same 32 bits,
//   signed, but another type. A mask becomes a `bool3` wherever one is expected.
// - clang 14 has no vector of `bool`: `bool3` is a class.
#pragma once

static_assert(sizeof(wchar_t) == 4 && wchar_t(-1) < 0, "wchar_t has 32 bits and a sign");

typedef unsigned char uchar;
typedef unsigned short ushort;
typedef unsigned long ulong;
typedef unsigned long size_t;
typedef long ptrdiff_t;
typedef signed char int8_t;
typedef unsigned char uint8_t;
typedef short int16_t;
typedef unsigned short uint16_t;
typedef int int32_t;
typedef unsigned int uint32_t;
typedef long int64_t;
typedef unsigned long uint64_t;

#define __LL_VECTORS(element, name)                              \
  typedef element name##2 __attribute__((ext_vector_type(2)));   \
  typedef element name##3 __attribute__((ext_vector_type(3)));   \
  typedef element name##4 __attribute__((ext_vector_type(4)));

__LL_VECTORS(float, float)
__LL_VECTORS(wchar_t, int)
__LL_VECTORS(unsigned int, uint)
__LL_VECTORS(short, short)
__LL_VECTORS(unsigned short, ushort)
__LL_VECTORS(signed char, char)
__LL_VECTORS(unsigned char, uchar)

/// A number of 16 bits, which clang computes with by `-fnative-half-type`.
typedef __fp16 half;
__LL_VECTORS(half, half)
inline half operator""h(long double value) { return half(float(value)); }
inline half operator""h(unsigned long long value) { return half(float(value)); }

namespace __lamplight {

__LL_VECTORS(int, mask)

struct bool2;
struct bool3;
struct bool4;

// Swizzles of `bool` vectors are properties. `__LL_2` lists those of x and y, `__LL_3` those of
// three letters, `__LL_4` of four; what is written for each is what `__LL_TO2`, `__LL_TO3` and
// `__LL_TO4` are when they are listed.
#define __LL_PAIRS2(m) m(x, x) m(x, y) m(y, x) m(y, y)
#define __LL_PAIRS3(m) __LL_PAIRS2(m) m(x, z) m(y, z) m(z, x) m(z, y) m(z, z)
#define __LL_PAIRS4(m) \
  __LL_PAIRS3(m) m(x, w) m(y, w) m(z, w) m(w, x) m(w, y) m(w, z) m(w, w)
#define __LL_THIRD2(a, b) __LL_TO3(a, b, x) __LL_TO3(a, b, y)
#define __LL_THIRD3(a, b) __LL_THIRD2(a, b) __LL_TO3(a, b, z)
#define __LL_THIRD4(a, b) __LL_THIRD3(a, b) __LL_TO3(a, b, w)
#define __LL_LAST2(a, b, c) __LL_TO4(a, b, c, x) __LL_TO4(a, b, c, y)
#define __LL_LAST3(a, b, c) __LL_LAST2(a, b, c) __LL_TO4(a, b, c, z)
#define __LL_LAST4(a, b, c) __LL_LAST3(a, b, c) __LL_TO4(a, b, c, w)
#define __LL_BOTH2(a, b) __LL_LAST2(a, b, x) __LL_LAST2(a, b, y)
#define __LL_BOTH3(a, b) __LL_LAST3(a, b, x) __LL_LAST3(a, b, y) __LL_LAST3(a, b, z)
#define __LL_BOTH4(a, b) \
  __LL_LAST4(a, b, x) __LL_LAST4(a, b, y) __LL_LAST4(a, b, z) __LL_LAST4(a, b, w)
#define __LL_2 __LL_PAIRS2(__LL_TO2) __LL_PAIRS2(__LL_THIRD2) __LL_PAIRS2(__LL_BOTH2)
#define __LL_3 __LL_PAIRS3(__LL_TO2) __LL_PAIRS3(__LL_THIRD3) __LL_PAIRS3(__LL_BOTH3)
#define __LL_4 __LL_PAIRS4(__LL_TO2) __LL_PAIRS4(__LL_THIRD4) __LL_PAIRS4(__LL_BOTH4)

#define __LL_TO2(a, b)      \
  bool2 get_##a##b() const; \
  __declspec(property(get = get_##a##b)) bool2 a##b;
#define __LL_TO3(a, b, c)       \
  bool3 get_##a##b##c() const;  \
  __declspec(property(get = get_##a##b##c)) bool3 a##b##c;
#define __LL_TO4(a, b, c, d)       \
  bool4 get_##a##b##c##d() const;  \
  __declspec(property(get = get_##a##b##c##d)) bool4 a##b##c##d;

#define __LL_FLAGS(n, each)                                                         \
  bool operator[](int i) const { return (&x)[i]; }                                  \
  bool& operator[](int i) { return (&x)[i]; }                                       \
  friend bool##n operator!(bool##n a) { return a.mask() == 0; }                     \
  friend bool##n operator&(bool##n a, bool##n b) { return a.mask() & b.mask(); }    \
  friend bool##n operator|(bool##n a, bool##n b) { return a.mask() | b.mask(); }    \
  friend bool##n operator&&(bool##n a, bool##n b) { return a.mask() & b.mask(); }   \
  friend bool##n operator||(bool##n a, bool##n b) { return a.mask() | b.mask(); }   \
  friend bool##n operator==(bool##n a, bool##n b) { return a.mask() == b.mask(); }  \
  friend bool##n operator!=(bool##n a, bool##n b) { return a.mask() != b.mask(); }  \
  each

struct alignas(2) bool2 {
  bool x, y;
  bool2() : x(false), y(false) {}
  bool2(mask2 m) : x(m.x != 0), y(m.y != 0) {}
  mask2 mask() const { return mask2{-int(x), -int(y)}; }
  __LL_FLAGS(2, __LL_2)
};
struct alignas(4) bool3 {
  bool x, y, z;
  bool3() : x(false), y(false), z(false) {}
  bool3(mask3 m) : x(m.x != 0), y(m.y != 0), z(m.z != 0) {}
  mask3 mask() const { return mask3{-int(x), -int(y), -int(z)}; }
  __LL_FLAGS(3, __LL_3)
};
struct alignas(4) bool4 {
  bool x, y, z, w;
  bool4() : x(false), y(false), z(false), w(false) {}
  bool4(mask4 m) : x(m.x != 0), y(m.y != 0), z(m.z != 0), w(m.w != 0) {}
  mask4 mask() const { return mask4{-int(x), -int(y), -int(z), -int(w)}; }
  __LL_FLAGS(4, __LL_4)
};

#undef __LL_TO2
#undef __LL_TO3
#undef __LL_TO4
#define __LL_TO2(a, b) \
  inline bool2 __LL_OF::get_##a##b() const { return mask2{a, b}; }
#define __LL_TO3(a, b, c) \
  inline bool3 __LL_OF::get_##a##b##c() const { return mask3{a, b, c}; }
#define __LL_TO4(a, b, c, d) \
  inline bool4 __LL_OF::get_##a##b##c##d() const { return mask4{a, b, c, d}; }
#define __LL_OF bool2
__LL_2
#undef __LL_OF
#define __LL_OF bool3
__LL_3
#undef __LL_OF
#define __LL_OF bool4
__LL_4
#undef __LL_OF

/// Three components without the fourth's room. It is used as the vector it converts to; swizzles
/// of it came with Metal 2.1 only.
template <class Element, class Vector> struct packed3 {
  Element parts[3];
  packed3() = default;
  packed3(Vector v) : parts{v.x, v.y, v.z} {}
  operator Vector() const { return Vector{parts[0], parts[1], parts[2]}; }
  Element operator[](int i) const { return parts[i]; }
  Element& operator[](int i) { return parts[i]; }

  friend Vector operator-(packed3 a) { return -Vector(a); }
#define __LL_OPERATOR(op)                                                           \
  friend Vector operator op(packed3 a, packed3 b) { return Vector(a) op Vector(b); } \
  friend Vector operator op(packed3 a, Vector b) { return Vector(a) op b; }          \
  friend Vector operator op(Vector a, packed3 b) { return a op Vector(b); }          \
  friend Vector operator op(packed3 a, Element b) { return Vector(a) op b; }         \
  friend Vector operator op(Element a, packed3 b) { return a op Vector(b); }
  __LL_OPERATOR(+)
  __LL_OPERATOR(-)
  __LL_OPERATOR(*)
  __LL_OPERATOR(/)
  // Of whole numbers. No body is compiled before it is used.
  friend Vector operator~(packed3 a) { return ~Vector(a); }
  __LL_OPERATOR(%)
  __LL_OPERATOR(&)
  __LL_OPERATOR(|)
  __LL_OPERATOR(^)
  __LL_OPERATOR(<<)
  __LL_OPERATOR(>>)
#undef __LL_OPERATOR
#define __LL_OPERATOR(op)                                                          \
  friend mask3 operator op(packed3 a, packed3 b) { return Vector(a) op Vector(b); } \
  friend mask3 operator op(packed3 a, Vector b) { return Vector(a) op b; }          \
  friend mask3 operator op(Vector a, packed3 b) { return a op Vector(b); }
  __LL_OPERATOR(==)
  __LL_OPERATOR(!=)
  __LL_OPERATOR(<)
  __LL_OPERATOR(<=)
  __LL_OPERATOR(>)
  __LL_OPERATOR(>=)
#undef __LL_OPERATOR
};

using packed_float3 = packed3<float, float3>;
using packed_int3 = packed3<wchar_t, int3>;
using packed_uint3 = packed3<unsigned int, uint3>;
using packed_half3 = packed3<half, half3>;

// A number with a sign is shifted by one without.
#define __LL_OPERATOR(op)                                                                   \
  inline int3 operator op(packed_int3 a, uint3 b) { return int3(a) op b; }                  \
  inline int3 operator op(packed_int3 a, packed_uint3 b) { return int3(a) op uint3(b); }    \
  inline int3 operator op(int3 a, packed_uint3 b) { return a op uint3(b); }
__LL_OPERATOR(<<)
__LL_OPERATOR(>>)
#undef __LL_OPERATOR

}  // namespace __lamplight

using __lamplight::bool2;
using __lamplight::bool3;
using __lamplight::bool4;
using __lamplight::packed_float3;
using __lamplight::packed_half3;
using __lamplight::packed_int3;
using __lamplight::packed_uint3;

namespace metal {
/// An array that is a value: functions take and return it.
template <class Element, unsigned long count> struct array {
  Element elements[count];
  Element& operator[](unsigned long at) { return elements[at]; }
  const Element& operator[](unsigned long at) const { return elements[at]; }
  static constexpr unsigned long size() { return count; }
};

using ::bool2;
using ::bool3;
using ::bool4;
using ::float2;
using ::float3;
using ::float4;
using ::half;
using ::half2;
using ::half3;
using ::half4;
using ::int2;
using ::int3;
using ::int4;
using ::packed_float3;
using ::packed_half3;
using ::packed_int3;
using ::packed_uint3;
using ::uchar;
using ::uint2;
using ::uint3;
using ::uint4;
using ::ulong;
using ::ushort;
using ::uint32_t;
using ::uint64_t;
typedef unsigned int uint;
}  // namespace metal
