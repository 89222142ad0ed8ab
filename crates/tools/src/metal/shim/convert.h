// Constructors of vectors, conversions of values, and bits read as another type.
//
// `float3(...)` cannot be a constructor of a built-in type: behind the headers it is a macro for
// `__lamplight_float3(...)`, and `static_cast` one for `__lamplight_cast`.
#pragma once

#include "types.h"

namespace __lamplight {

/// Number and type of components; for a scalar, itself.
template <class T> struct shape {
  static constexpr int size = 1;
  using element = T;
};
#define __LL_SHAPE(V, E, n)            \
  template <> struct shape<V> {        \
    static constexpr int size = n;     \
    using element = E;                 \
  };
#define __LL_SHAPES(E, name) \
  __LL_SHAPE(name##2, E, 2) __LL_SHAPE(name##3, E, 3) __LL_SHAPE(name##4, E, 4)
__LL_SHAPES(float, float)
__LL_SHAPES(wchar_t, int)
__LL_SHAPES(unsigned int, uint)
__LL_SHAPES(short, short)
__LL_SHAPES(unsigned short, ushort)
__LL_SHAPES(signed char, char)
__LL_SHAPES(unsigned char, uchar)
__LL_SHAPES(bool, bool)
__LL_SHAPES(bool, mask)
__LL_SHAPES(half, half)
__LL_SHAPE(packed_float3, float, 3)
__LL_SHAPE(packed_int3, wchar_t, 3)
__LL_SHAPE(packed_uint3, unsigned int, 3)
__LL_SHAPE(packed_half3, half, 3)

template <class T> constexpr int size_of = shape<T>::size;
template <class T> using element_of = typename shape<T>::element;

template <class A, class B> constexpr bool same = __is_same(A, B);

/// A component; a scalar is its own.
template <class T> inline element_of<T> part(const T& v, int i) {
  if constexpr (size_of<T> == 1) {
    return v;
  } else {
    return element_of<T>(v[i]);
  }
}

/// A value of another type, component by component.
template <class To, class From> inline To converted(const From& v) {
  static_assert(size_of<To> == size_of<From> || size_of<From> == 1,
                "a vector converts to one of as many components");
  using Element = element_of<To>;
  if constexpr (size_of<To> == 1) {
    return To(v);
  } else {
    To to = {};
    for (int i = 0; i < size_of<To>; ++i) to[i] = Element(part(v, i));
    return to;
  }
}

template <class To> inline int put(To&, int at) { return at; }

template <class To, class From, class... Rest>
inline int put(To& to, int at, const From& from, const Rest&... rest) {
  static_assert(size_of<From> == 1 || same<element_of<From>, element_of<To>>,
                "a vector is put together from vectors of its own components");
  for (int i = 0; i < size_of<From>; ++i) to[at + i] = element_of<To>(part(from, i));
  return put(to, at + size_of<From>, rest...);
}

template <class To, class First, class... Rest>
inline To constructed(const First& first, const Rest&... rest) {
  if constexpr (sizeof...(Rest) == 0) {
    return converted<To>(first);
  } else {
    static_assert((size_of<First> + ... + size_of<Rest>) == size_of<To>,
                  "a vector takes as many components as it has");
    To to = {};
    put(to, 0, first, rest...);
    return to;
  }
}

}  // namespace __lamplight

#define __LL_CONSTRUCTOR(V)                                            \
  template <class... From> inline V __lamplight_##V(From... from) {    \
    return __lamplight::constructed<V>(from...);                       \
  }
#define __LL_CONSTRUCTORS(name) \
  __LL_CONSTRUCTOR(name##2) __LL_CONSTRUCTOR(name##3) __LL_CONSTRUCTOR(name##4)
__LL_CONSTRUCTORS(float)
__LL_CONSTRUCTORS(int)
__LL_CONSTRUCTORS(uint)
__LL_CONSTRUCTORS(bool)
__LL_CONSTRUCTORS(half)
__LL_CONSTRUCTORS(short)
__LL_CONSTRUCTORS(ushort)

// What is written most, without a template.
inline float2 __lamplight_float2(float x, float y) { return float2{x, y}; }
inline float3 __lamplight_float3(float x, float y, float z) { return float3{x, y, z}; }
inline float3 __lamplight_float3(float x) { return float3{x, x, x}; }
inline float3 __lamplight_float3(packed_float3 v) { return v; }
inline float4 __lamplight_float4(float x, float y, float z, float w) {
  return float4{x, y, z, w};
}

namespace metal {
#define __LL_NAMES(name)             \
  using ::__lamplight_##name##2;     \
  using ::__lamplight_##name##3;     \
  using ::__lamplight_##name##4;
__LL_NAMES(float)
__LL_NAMES(int)
__LL_NAMES(uint)
__LL_NAMES(bool)
__LL_NAMES(half)
__LL_NAMES(short)
__LL_NAMES(ushort)
}  // namespace metal

/// What `static_cast` is in a shader.
template <class To, class From> inline To __lamplight_cast(From v) {
  return __lamplight::converted<To>(v);
}

/// The bits of a value as another type of the same size.
template <class To, class From> inline To as_type(From v) {
  static_assert(sizeof(To) == sizeof(From), "`as_type` is between types of one size");
  return __builtin_bit_cast(To, v);
}

namespace __lamplight {

/// A vector, as it is; a comparison of vectors as `bool`s.
template <class T> inline T truth(T v) { return v; }
inline bool2 truth(mask2 v) { return v; }
inline bool3 truth(mask3 v) { return v; }
inline bool4 truth(mask4 v) { return v; }

}  // namespace __lamplight

/// Function constants are not set.
template <class T> inline bool is_function_constant_defined(const T&) { return false; }
