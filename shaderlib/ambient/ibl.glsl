//! Ambient light from images of the surroundings. The caller reads the maps; these functions say where and combine.

#ifndef LAMPLIGHT_AMBIENT_IBL_GLSL
#define LAMPLIGHT_AMBIENT_IBL_GLSL

/// A surface's colour with the diffuse and specular maps mixed in.
vec3 ibl_mix(vec3 base, vec3 diffuse, vec3 specular, float dp, float sp) {
    vec3 c = mix(base, diffuse * base, dp);
    return mix(c, specular + c, sp);
}

/// The direction in which a mirror shows its surroundings, in world space.
vec3 reflect_world(mat3 view_rot, vec3 n, vec3 v) {
    return transpose(view_rot) * reflect(-v, n);
}

/// Specular light from a prefiltered environment, by the split-sum approximation.
vec3 split_sum(vec3 f0, vec2 dfg, vec3 prefiltered) {
    return prefiltered * (f0 * dfg.x + dfg.y);
}

#endif
