//! Matrices that WGSL has no function for.

#ifndef LAMPLIGHT_MATH_MATRIX_GLSL
#define LAMPLIGHT_MATH_MATRIX_GLSL

#include "safe.glsl"

/// The inverse of a 3x3 matrix.
mat3 inverse3(mat3 m) {
    vec3 yz = cross(m[1], m[2]);
    float det = dot(m[0], yz);
    if (!(abs(det) >= SMALLEST_NORMAL)) {
        return mat3(vec3(0.0), vec3(0.0), vec3(0.0));
    }
    return transpose(mat3(yz / det, cross(m[2], m[0]) / det, cross(m[0], m[1]) / det));
}

/// The matrix that takes normals where `model` takes points: the inverse, transposed, of its upper 3x3 part.
mat3 normal_matrix(mat4 model) {
    vec3 x = model[0].xyz;
    vec3 y = model[1].xyz;
    vec3 z = model[2].xyz;
    vec3 yz = cross(y, z);
    float det = dot(x, yz);
    float scale = abs(det) >= SMALLEST_NORMAL ? det : 1.0;
    return mat3(yz / scale, cross(z, x) / scale, cross(x, y) / scale);
}

#endif
