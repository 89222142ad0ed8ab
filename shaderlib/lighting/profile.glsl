//! Where the profile or the picture of a light is read: photometric files and cookies.
//!
//! Made from `profile.wesl` by `cargo xtask docs`: edit that, not this file.

#ifndef LAMPLIGHT_LIGHTING_PROFILE_GLSL
#define LAMPLIGHT_LIGHTING_PROFILE_GLSL

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

/// The texture coordinate for a photometric profile that is symmetric about the light's axis.
///
/// Parameters: `c` cosine of the angle between the light's axis and the direction from it to the point: `dot(-l, axis)`, [-1, 1].
/// Returns: the angle over pi, [0, 1]: a coordinate of the profile's texture, 0 on the axis.
/// Source: IES LM-63: vertical angles from the nadir to the zenith; Lagarde, de Rousiers, "Moving Frostbite to Physically Based Rendering", 2014, section 4.9.
/// Edges: cosines outside [-1, 1] are clamped to it.
/// Error model: absolute 2e-6; 2^-24/sqrt(1 - c^2) more where the cosine itself is rounded.
float ies_u(float c) {
    float x = clamp(c, -1.0, 1.0);
    return 0.31830987 * atan(sqrt((1.0 - x) * (1.0 + x)), x);
}

/// The texture coordinates for a photometric profile over the vertical and the horizontal angle.
///
/// Parameters: `l` unit, from the point to the light; `axis` unit, the light's direction into the scene, the same space; `right` unit, at right angles to `axis`: the half plane of the horizontal angle 0.
/// Returns: `ies_u` in x; in y the horizontal angle over 2*pi, [0, 1], from `right` towards `cross(axis, right)`.
/// Source: IES LM-63: vertical and horizontal angles of type C.
/// Edges: y is 0 where `l` is along `axis`, and where `l` or `right` is zero; x is 0.5 where `l` or `axis` is zero, and y is 0 or 0.5 for a zero `axis`.
/// Error model: absolute 3e-6 + 2^-23/s in y, with s the sine of the vertical angle.
vec2 ies_uv(vec3 l, vec3 axis, vec3 right) {
    vec3 away = -l;
    float x = dot(away, right);
    float y = dot(away, cross(axis, right));
    // Zeros have signs, which would choose between turns.
    float turn = x < 0.0 ? 0.5 : 0.0;
    if (y != 0.0) {
        turn = 0.15915494 * atan(y, x);
    }
    return vec2(ies_u(dot(away, axis)), turn < 0.0 ? turn + 1.0 : turn);
}

/// The texture coordinates for a light cookie: a picture that a light projects.
///
/// Parameters: `p` the lit point, scene units; `m` from the space of `p` to the light's texture coordinates: a projection, then a scale of 0.5 and an offset of 0.5.
/// Returns: the coordinates in xy; z is 1 before the light and 0 behind it, where nothing is projected.
/// Source: Segal et al., "Fast Shadows and Lighting Effects Using Texture Mapping", 1992, section 3.
/// Edges: zero where the last homogeneous coordinate of `p` is 1e-30 or less, so for an `m` of zeros.
/// Error model: 8*2^-23 of the sums of the terms' magnitudes over w.
vec3 cookie_uv(vec3 p, mat4 m) {
    vec4 q = m * vec4(p, 1.0);
    if (!(q.w > 1e-30)) {
        return vec3(0.0);
    }
    return vec3(q.xy / q.w, 1.0);
}

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

#endif
