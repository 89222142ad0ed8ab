// Matrices: columns of vectors.
#pragma once

#include "convert.h"

namespace __lamplight {

template <int N> struct float_vector;
template <> struct float_vector<2> { using type = float2; };
template <> struct float_vector<3> { using type = float3; };
template <> struct float_vector<4> { using type = float4; };
template <int N> using floats = typename float_vector<N>::type;

template <int Columns, int Rows> struct matrix {
  using column = floats<Rows>;
  using row = floats<Columns>;
  column columns[Columns];

  matrix() : columns{} {}
  /// With the number on the diagonal.
  explicit matrix(float diagonal) : columns{} {
    for (int i = 0; i < Columns && i < Rows; ++i) columns[i][i] = diagonal;
  }
  /// From columns, or from all numbers.
  template <class... Parts> matrix(column first, Parts... rest) : columns{first, column(rest)...} {
    static_assert(1 + sizeof...(Parts) == Columns, "a matrix takes as many columns as it has");
  }
  template <class... Parts> matrix(float first, float second, Parts... rest) {
    static_assert(2 + sizeof...(Parts) == Columns * Rows,
                  "a matrix takes as many numbers as it has");
    const float all[] = {first, second, float(rest)...};
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
  friend matrix operator*(const matrix& a, float b) {
    matrix to;
    for (int i = 0; i < Columns; ++i) to[i] = a[i] * b;
    return to;
  }
  friend matrix operator*(float a, const matrix& b) { return b * a; }
  friend column operator*(const matrix& a, row b) {
    column to = a[0] * b[0];
    for (int i = 1; i < Columns; ++i) to += a[i] * b[i];
    return to;
  }
  friend row operator*(column a, const matrix& b) {
    row to = {};
    for (int i = 0; i < Columns; ++i) {
      float sum = a[0] * b[i][0];
      for (int j = 1; j < Rows; ++j) sum += a[j] * b[i][j];
      to[i] = sum;
    }
    return to;
  }
};

template <int Columns, int Inner, int Rows>
inline matrix<Columns, Rows> operator*(const matrix<Inner, Rows>& a,
                                       const matrix<Columns, Inner>& b) {
  matrix<Columns, Rows> to;
  for (int i = 0; i < Columns; ++i) to[i] = a * b[i];
  return to;
}

}  // namespace __lamplight

namespace metal {

using float2x2 = __lamplight::matrix<2, 2>;
using float2x3 = __lamplight::matrix<2, 3>;
using float2x4 = __lamplight::matrix<2, 4>;
using float3x2 = __lamplight::matrix<3, 2>;
using float3x3 = __lamplight::matrix<3, 3>;
using float3x4 = __lamplight::matrix<3, 4>;
using float4x2 = __lamplight::matrix<4, 2>;
using float4x3 = __lamplight::matrix<4, 3>;
using float4x4 = __lamplight::matrix<4, 4>;

template <int Columns, int Rows>
inline __lamplight::matrix<Rows, Columns> transpose(const __lamplight::matrix<Columns, Rows>& m) {
  __lamplight::matrix<Rows, Columns> to;
  for (int i = 0; i < Columns; ++i)
    for (int j = 0; j < Rows; ++j) to[j][i] = m[i][j];
  return to;
}

inline float determinant(const float2x2& m) { return m[0].x * m[1].y - m[0].y * m[1].x; }
inline float determinant(const float3x3& m) {
  return m[0].x * (m[1].y * m[2].z - m[1].z * m[2].y) -
         m[0].y * (m[1].x * m[2].z - m[1].z * m[2].x) +
         m[0].z * (m[1].x * m[2].y - m[1].y * m[2].x);
}
inline float determinant(const float4x4& m) {
  float to = 0.0f;
  for (int i = 0; i < 4; ++i) {
    float3x3 rest;
    for (int j = 0, k = 0; j < 4; ++j)
      if (j != i) rest[k++] = m[j].yzw;
    to += (i % 2 == 0 ? m[i].x : -m[i].x) * determinant(rest);
  }
  return to;
}

}  // namespace metal
