//! Matrices that WGSL has no function for.
//!
//! Made from `matrix.wesl` by `cargo xtask docs`: edit that, not this file.

#ifndef LAMPLIGHT_MATH_MATRIX_GLSL
#define LAMPLIGHT_MATH_MATRIX_GLSL

#include "safe.glsl"

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

/// The inverse of a 3x3 matrix.
///
/// Parameters: `m` any matrix.
/// Returns: its inverse.
/// Source: Cramer's rule: the rows of the inverse are the cross products of the columns, divided by the determinant.
/// Edges: all zeros where the determinant's magnitude is below 2^-126, a singular matrix included; members beyond 3e38 count as that.
/// Error model: absolute 3*2^-23*(s^2/|det| + s^5/det^2) per element, with s the longest column's length.
mat3 inverse3(mat3 m) {
    vec3 yz = cross(m[1], m[2]);
    float det = dot(m[0], yz);
    if (!(abs(det) >= SMALLEST_NORMAL)) {
        return mat3(vec3(0.0), vec3(0.0), vec3(0.0));
    }
    return transpose(mat3(
        clamp(yz / det, vec3(-3e38), vec3(3e38)),
        clamp(cross(m[2], m[0]) / det, vec3(-3e38), vec3(3e38)),
        clamp(cross(m[0], m[1]) / det, vec3(-3e38), vec3(3e38))
    ));
}

/// The normal matrix of a model matrix: the inverse transpose of its upper left 3x3 part.
///
/// Parameters: `model` an affine transform, for column vectors.
/// Returns: the normal matrix; its results are not unit. A rotation with one scale for all axes may use the 3x3 part itself.
/// Source: Movania et al., OpenGL: Build High Performance Graphics, 2017, chapter 4, per-vertex and per-fragment lighting; Newcastle University, Graphics for Games, tutorial 11 "Real-Time Lighting A"; Igalia, "Working with lights and shadows", part I.
/// Edges: for a flattened model the division by the determinant is left out: the directions are still right; members beyond 3e38 count as that.
/// Error model: that of `inverse3`.
mat3 normal_matrix(mat4 model) {
    vec3 x = model[0].xyz;
    vec3 y = model[1].xyz;
    vec3 z = model[2].xyz;
    vec3 yz = cross(y, z);
    float det = dot(x, yz);
    float scale = abs(det) >= SMALLEST_NORMAL ? det : 1.0;
    return mat3(
        clamp(yz / scale, vec3(-3e38), vec3(3e38)),
        clamp(cross(z, x) / scale, vec3(-3e38), vec3(3e38)),
        clamp(cross(x, y) / scale, vec3(-3e38), vec3(3e38))
    );
}

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

#endif
