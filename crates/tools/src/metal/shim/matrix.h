// Matrices: columns of vectors.
#pragma once

#include "convert.h"

namespace __lamplight {

template <class T, int N> struct vector_of;
template <> struct vector_of<float, 2> { using type = float2; };
template <> struct vector_of<float, 3> { using type = float3; };
template <> struct vector_of<float, 4> { using type = float4; };
template <> struct vector_of<half, 2> { using type = half2; };
template <> struct vector_of<half, 3> { using type = half3; };
template <> struct vector_of<half, 4> { using type = half4; };

template <class T, int Columns, int Rows> struct matrix {
  using column = typename vector_of<T, Rows>::type;
  using row = typename vector_of<T, Columns>::type;
  column columns[Columns];

  matrix() : columns{} {}
  /// With the number on the diagonal.
  explicit matrix(T diagonal) : columns{} {
    for (int i = 0; i < Columns && i < Rows; ++i) columns[i][i] = diagonal;
  }
  /// From columns, or from all numbers.
  template <class... Parts> matrix(column first, Parts... rest) : columns{first, column(rest)...} {
    static_assert(1 + sizeof...(Parts) == Columns, "a matrix takes as many columns as it has");
  }
  template <class... Parts> matrix(T first, T second, Parts... rest) {
    static_assert(2 + sizeof...(Parts) == Columns * Rows,
                  "a matrix takes as many numbers as it has");
    const T all[] = {first, second, T(rest)...};
    for (int i = 0; i < Columns * Rows; ++i) columns[i / Rows][i % Rows] = all[i];
  }

  const column& operator[](int i) const { return columns[i]; }
  column& operator[](int i) { return columns[i]; }

  friend matrix operator+(const matrix& a, const matrix& b) {
    matrix to;
    for (int i = 0; i < Columns; ++i) to[i] = a[i] + b[i];
    return to;
  }
  friend matrix operator-(const matrix& a, const matrix& b) {
    matrix to;
    for (int i = 0; i < Columns; ++i) to[i] = a[i] - b[i];
    return to;
  }
  friend matrix operator-(const matrix& a) {
    matrix to;
    for (int i = 0; i < Columns; ++i) to[i] = -a[i];
    return to;
  }
  friend matrix operator*(const matrix& a, T b) {
    matrix to;
    for (int i = 0; i < Columns; ++i) to[i] = a[i] * b;
    return to;
  }
  friend matrix operator*(T a, const matrix& b) { return b * a; }
  friend column operator*(const matrix& a, row b) {
    column to = a[0] * b[0];
    for (int i = 1; i < Columns; ++i) to += a[i] * b[i];
    return to;
  }
  friend row operator*(column a, const matrix& b) {
    row to = {};
    for (int i = 0; i < Columns; ++i) {
      T sum = a[0] * b[i][0];
      for (int j = 1; j < Rows; ++j) sum += a[j] * b[i][j];
      to[i] = sum;
    }
    return to;
  }
};

template <class T, int Columns, int Inner, int Rows>
inline matrix<T, Columns, Rows> operator*(const matrix<T, Inner, Rows>& a,
                                          const matrix<T, Columns, Inner>& b) {
  matrix<T, Columns, Rows> to;
  for (int i = 0; i < Columns; ++i) to[i] = a * b[i];
  return to;
}

}  // namespace __lamplight

namespace metal {

using float2x2 = __lamplight::matrix<float, 2, 2>;
using float2x3 = __lamplight::matrix<float, 2, 3>;
using float2x4 = __lamplight::matrix<float, 2, 4>;
using float3x2 = __lamplight::matrix<float, 3, 2>;
using float3x3 = __lamplight::matrix<float, 3, 3>;
using float3x4 = __lamplight::matrix<float, 3, 4>;
using float4x2 = __lamplight::matrix<float, 4, 2>;
using float4x3 = __lamplight::matrix<float, 4, 3>;
using float4x4 = __lamplight::matrix<float, 4, 4>;
using half2x2 = __lamplight::matrix<half, 2, 2>;
using half2x3 = __lamplight::matrix<half, 2, 3>;
using half2x4 = __lamplight::matrix<half, 2, 4>;
using half3x2 = __lamplight::matrix<half, 3, 2>;
using half3x3 = __lamplight::matrix<half, 3, 3>;
using half3x4 = __lamplight::matrix<half, 3, 4>;
using half4x2 = __lamplight::matrix<half, 4, 2>;
using half4x3 = __lamplight::matrix<half, 4, 3>;
using half4x4 = __lamplight::matrix<half, 4, 4>;

template <class T, int Columns, int Rows>
inline __lamplight::matrix<T, Rows, Columns> transpose(
    const __lamplight::matrix<T, Columns, Rows>& m) {
  __lamplight::matrix<T, Rows, Columns> to;
  for (int i = 0; i < Columns; ++i)
    for (int j = 0; j < Rows; ++j) to[j][i] = m[i][j];
  return to;
}

template <class T> inline T determinant(const __lamplight::matrix<T, 2, 2>& m) {
  return m[0].x * m[1].y - m[0].y * m[1].x;
}
template <class T> inline T determinant(const __lamplight::matrix<T, 3, 3>& m) {
  return m[0].x * (m[1].y * m[2].z - m[1].z * m[2].y) -
         m[0].y * (m[1].x * m[2].z - m[1].z * m[2].x) +
         m[0].z * (m[1].x * m[2].y - m[1].y * m[2].x);
}
template <class T> inline T determinant(const __lamplight::matrix<T, 4, 4>& m) {
  T to = 0;
  for (int i = 0; i < 4; ++i) {
    __lamplight::matrix<T, 3, 3> rest;
    for (int j = 0, k = 0; j < 4; ++j)
      if (j != i) rest[k++] = m[j].yzw;
    to += (i % 2 == 0 ? m[i].x : -m[i].x) * determinant(rest);
  }
  return to;
}

}  // namespace metal
