//! Ambient light from images of the surroundings. The caller reads the maps; these functions say where and combine.

#ifndef LAMPLIGHT_AMBIENT_IBL_GLSL
#define LAMPLIGHT_AMBIENT_IBL_GLSL

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

/// A surface's colour with the diffuse and specular maps mixed in.
///
/// Parameters: `base` surface's linear colour, [0, 1]; `diffuse`, `specular` linear colours read from the maps, at least 0; `dp`, `sp` their shares, [0, 1].
/// Returns: `c = mix(base, diffuse*base, dp)`, then `mix(c, specular + c, sp)`, linear, not clamped.
/// Source: Shreiner et al., OpenGL Programming Guide, 8th edition, 2013, example 7.13.
/// Edges: `base` for both shares 0.
/// Error model: absolute 2*2^-23*(|base|*(1 + |diffuse|) + |specular|).
vec3 ibl_mix(vec3 base, vec3 diffuse, vec3 specular, float dp, float sp) {
    vec3 c = mix(base, diffuse * base, dp);
    return mix(c, specular + c, sp);
}

/// The direction in which a mirror shows its surroundings, in world space.
///
/// The book reflects in eye space, so that its environment turns with the camera; the view's rotation is undone here.
///
/// Parameters: `view_rot` rotation from world to eye space; `n`, `v` unit, eye space, `v` away from the surface.
/// Returns: unit vector, world space.
/// Source: Shreiner et al., OpenGL Programming Guide, 8th edition, 2013, example 7.13, with the rotation added.
/// Edges: the transpose is the inverse of rotations only.
/// Error model: absolute 8*2^-23 per component.
vec3 reflect_world(mat3 view_rot, vec3 n, vec3 v) {
    return transpose(view_rot) * reflect(-v, n);
}

/// Specular light from a prefiltered environment, by the split-sum approximation.
///
/// Parameters: `f0` linear reflectance at normal incidence, [0, 1]; `dfg` scale and offset of `f0` from the table over n.v and roughness, [0, 1]; `prefiltered` linear colour of the environment for the roughness, at least 0.
/// Returns: `prefiltered*(f0*dfg.x + dfg.y)`, linear.
/// Source: Karis, "Real Shading in Unreal Engine 4", 2013.
/// Edges: none.
/// Error model: 3 ULP.
vec3 split_sum(vec3 f0, vec2 dfg, vec3 prefiltered) {
    return prefiltered * (f0 * dfg.x + dfg.y);
}

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

#endif
