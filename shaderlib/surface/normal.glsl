//! Normals: of triangles, from textures, and of the visible side.

#ifndef LAMPLIGHT_SURFACE_NORMAL_GLSL
#define LAMPLIGHT_SURFACE_NORMAL_GLSL

#include "../math/safe.glsl"

/// The normal of a triangle, twice its area long.
vec3 face_normal_area(vec3 a, vec3 b, vec3 c) {
    return cross(b - a, c - a);
}

/// The unit normal of a triangle, towards the side that sees its corners counter-clockwise.
vec3 face_normal(vec3 a, vec3 b, vec3 c) {
    return safe_normalize(face_normal_area(a, b, c), vec3(0.0, 0.0, 1.0));
}

/// The normal bent by a normal map.
vec3 perturb_normal(vec3 n, vec4 tangent, vec3 texel) {
    vec3 t = safe_normalize(tangent.xyz - n * dot(n, tangent.xyz), vec3(0.0));
    if (dot(t, t) == 0.0) {
        return n;
    }
    vec3 b = cross(n, t) * tangent.w;
    vec3 bent = 2.0 * texel - 1.0;
    return safe_normalize(t * bent.x + b * bent.y + n * bent.z, n);
}

/// The normal of the visible side.
vec3 flip_if_back(vec3 n, bool front) {
    return front ? n : -n;
}

#endif
