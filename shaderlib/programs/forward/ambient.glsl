//! Light from everywhere, for `forward`.

#ifndef LAMPLIGHT_PROGRAMS_FORWARD_AMBIENT_GLSL
#define LAMPLIGHT_PROGRAMS_FORWARD_AMBIENT_GLSL

#if AMBIENT != AMBIENT_NONE && AMBIENT != AMBIENT_DDGI
/// Light from everywhere: each value of `ambient` reads what it needs.
layout(std140, set = 0, binding = 2) uniform Surroundings {
    /// `constant`: added to the ambient light of the lamps.
    vec3 color;
    /// `sh9`: factor, 1/pi for coefficients of radiance.
    float scale;
    /// `hemisphere`: the light from the side of `up`.
    vec3 sky;
    /// `ibl`: share of the diffuse environment, [0, 1].
    float diffuse_share;
    /// `hemisphere`: the light from the other side.
    vec3 ground;
    /// `ibl`: share of the specular environment, [0, 1].
    float specular_share;
    /// `hemisphere`: unit, in the world.
    vec3 up;
    /// `sh9`: L00, L1m1, L10, L11, L2m2, L2m1, L20, L21, L22.
    vec3 sh[9];
} surroundings;
#endif

#if AMBIENT == AMBIENT_CONSTANT
/// Light from everywhere.
vec3 ambient_light(vec3 normal) {
    return surroundings.color;
}
#elif AMBIENT == AMBIENT_HEMISPHERE
#include "../../ambient/hemisphere.glsl"

/// Light from everywhere, onto a surface of this unit normal.
vec3 ambient_light(vec3 normal) {
    return hemisphere(normal, surroundings.up, surroundings.sky, surroundings.ground);
}
#elif AMBIENT == AMBIENT_SH9
#include "../../ambient/sh.glsl"

/// Light from everywhere, onto a surface of this unit normal.
vec3 ambient_light(vec3 normal) {
    return surroundings.scale * sh9_irradiance_clamped(normal, surroundings.sh);
}
#elif AMBIENT == AMBIENT_DDGI
#include "../probes.glsl"
#elif AMBIENT == AMBIENT_IBL
layout(set = 0, binding = 12) uniform textureCube sky_diffuse;
layout(set = 0, binding = 13) uniform textureCube sky_specular;
layout(set = 0, binding = 14) uniform sampler sky_sampler;
#endif

#endif
