//! Profiles of lamps, for `forward` with `profile`: how much a lamp sends where.
//!
//! With `profile=ies` it is what was measured of a luminaire, by the angles to the lamp's axis and
//! around it; a point light has an axis too. With `profile=cookie` it is the colour of a picture that
//! the lamp projects, and beside the picture it is dark. All lamps read parts of one texture.
//!
//! Made from `profiles.wesl` by `cargo xtask docs`: edit that, not this file.

#ifndef LAMPLIGHT_PROGRAMS_PROFILES_GLSL
#define LAMPLIGHT_PROGRAMS_PROFILES_GLSL

#if PROFILE == PROFILE_IES || PROFILE == PROFILE_COOKIE
#include "../lighting/light.glsl"
#include "../lighting/profile.glsl"
#endif

/// How a lamp reads its profile.
struct Profile {
    /// `cookie`: from the world to the coordinates of the picture, as `cookie_uv` has it.
    mat4 uv_from_world;
    /// `ies`: unit, in the world, at right angles to the lamp's axis: the horizontal angle 0.
    vec3 right;
    /// How much the profile counts, [0, 1]: with 0 the lamp has none.
    float share;
    /// The lamp's part of the texture: coordinates in [0, 1] are multiplied with `scale`, then `offset`
    /// is added. From the middle of its first texel to that of its last, so that no others are mixed in.
    vec2 scale;
    vec2 offset;
};

#if PROFILE == PROFILE_IES || PROFILE == PROFILE_COOKIE
layout(set = 1, binding = 13) uniform texture2D profile_map;
layout(set = 1, binding = 14) uniform sampler lamp_sampler;
#endif

#if PROFILE == PROFILE_IES
/// What a lamp sends to a point, as a factor on its colour. `l` is the unit direction to the lamp.
vec3 profile_factor(Profile profile, Light light, vec3 l, vec3 position) {
#if LIGHTS == LIGHTS_MIXED
    // Light of one direction comes from no place, so it has no angles.
    if (light.kind != LIGHT_POINT && light.kind != LIGHT_SPOT) {
        return vec3(1.0);
    }
#endif
    vec2 at = profile.scale * ies_uv(l, light.axis, profile.right) + profile.offset;
    return vec3(mix(1.0, textureLod(sampler2D(profile_map, lamp_sampler), at, 0.0).x, profile.share));
}
#elif PROFILE == PROFILE_COOKIE
vec3 profile_factor(Profile profile, Light light, vec3 l, vec3 position) {
    vec3 uv = cookie_uv(position, profile.uv_from_world);
    vec2 at = profile.scale * uv.xy + profile.offset;
    vec3 color = textureLod(sampler2D(profile_map, lamp_sampler), at, 0.0).rgb;
    bool is_inside = uv.z > 0.0 && all(greaterThanEqual(uv.xy, vec2(0.0))) && all(lessThanEqual(uv.xy, vec2(1.0)));
    return mix(vec3(1.0), is_inside ? color : vec3(0.0), profile.share);
}
#endif

#endif
