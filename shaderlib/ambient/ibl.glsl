//! Ambient light from images of the surroundings. The caller reads the maps. These functions give directions and mip levels, and combine the results.
//!
//! Made from `ibl.wesl` by `cargo xtask docs`: edit that, not this file.

#ifndef LAMPLIGHT_AMBIENT_IBL_GLSL
#define LAMPLIGHT_AMBIENT_IBL_GLSL

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

/// A surface's colour with the diffuse and specular maps mixed in.
///
/// Parameters: `base` surface's linear colour, [0, 1]; `diffuse`, `specular` linear colours read from the maps, at least 0; `dp`, `sp` their shares, [0, 1].
/// Returns: `c = mix(base, diffuse*base, dp)`, then `mix(c, specular + c, sp)`, linear, not clamped.
/// Source: Kessenich, Sellers, Shreiner, OpenGL Programming Guide, 9th edition, 2016, example 7.13.
/// Edges: `base` where `dp` and `sp` are both 0; no parameter is clamped, so shares outside [0, 1] extrapolate.
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
/// Source: Kessenich, Sellers, Shreiner, OpenGL Programming Guide, 9th edition, 2016, example 7.13, with the rotation added.
/// Edges: the transpose of a `view_rot` that is not a rotation is not its inverse; the direction `-v` for a zero `n`, zero for a zero `v`.
/// Error model: absolute 8*2^-23 per component.
vec3 reflect_world(mat3 view_rot, vec3 n, vec3 v) {
    return transpose(view_rot) * reflect(-v, n);
}

/// Specular light from a prefiltered environment, by the split-sum approximation.
///
/// Parameters: `f0` linear reflectance at normal incidence, [0, 1]; `dfg` scale and offset of `f0` from the table over n.v and roughness, [0, 1]; `prefiltered` linear colour of the environment for the roughness, at least 0.
/// Returns: `prefiltered*(f0*dfg.x + dfg.y)`, linear.
/// Source: Karis, "Real Shading in Unreal Engine 4", 2013.
/// Edges: 0 for a black `prefiltered` and for a `dfg` of zeros; no parameter is clamped.
/// Error model: 3 ULP.
vec3 split_sum(vec3 f0, vec2 dfg, vec3 prefiltered) {
    return prefiltered * (f0 * dfg.x + dfg.y);
}

/// The parallax-corrected direction for the lookup in a local environment map, whose surroundings are a box.
///
/// Parameters: `r` mirror direction, world space, of a length from 1e-6 to 1e6; `p` the reflecting point, world space, scene units; `lo`, `hi` lowest and highest corner of the box, world space, scene units; `c` position from which the map was captured, anywhere, world space, scene units.
/// Returns: from `c` to where the ray from `p` leaves the box, world space, scene units.
/// Source: Lagarde, Zanuttini, "Local Image-Based Lighting with Parallax-Corrected Cubemaps", 2012.
/// Edges: a wall of `lo` or `hi` that is behind `p`, seen along the ray, counts as at `p`, where the ray ends; a component of `r` below 1e-20 counts as 0; `p - c` for a zero `r`.
/// Error model: absolute 2^-20*(|hi| + |lo| + |p| + |c|) over the largest component of the unit direction.
vec3 box_project(vec3 r, vec3 p, vec3 lo, vec3 hi, vec3 c) {
    vec3 wall = (mix(lo, hi, greaterThan(r, vec3(0.0))) - p) / r;
    // The wall that is reached first; one along the ray never is.
    vec3 away = mix(vec3(1e20), wall, greaterThan(abs(r), vec3(1e-20)));
    return p + r * max(min(min(away.x, away.y), away.z), 0.0) - c;
}

/// The mip level of a prefiltered environment for a roughness.
///
/// Parameters: `roughness` perceptual, [0, 1]; `mips` number of levels, at least 1.
/// Returns: `roughness*(mips - 1)`, [0, mips - 1].
/// Source: Karis, "Real Shading in Unreal Engine 4", 2013: levels even in perceptual roughness.
/// Edges: a `roughness` outside [0, 1] is clamped; 0 for `mips` of 1 or below.
/// Error model: 1 ULP.
float prefilter_lod(float roughness, float mips) {
    return clamp(roughness, 0.0, 1.0) * max(mips - 1.0, 0.0);
}

/// The mip level of a prefiltered environment as Filament and three.js lay out the levels.
///
/// It differs from `prefilter_lod` in that more levels are spent on smooth surfaces.
///
/// Parameters: `roughness` perceptual, [0, 1]; `mips` number of levels, at least 1.
/// Returns: `roughness*(2 - roughness)*(mips - 1)`, [0, mips - 1].
/// Source: Guy, Agopian, "Physically Based Rendering in Filament", section 5.3.4.4; its source has this fit of the inverse of its levels.
/// Edges: a `roughness` outside [0, 1] is clamped; 0 for `mips` of 1 or below.
/// Error model: 3 ULP.
float prefilter_lod_filament(float roughness, float mips) {
    float r = clamp(roughness, 0.0, 1.0);
    return r * (2.0 - r) * max(mips - 1.0, 0.0);
}

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

#endif
