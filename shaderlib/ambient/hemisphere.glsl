//! Ambient light from a sky above and a ground below.
//!
//! Made from `hemisphere.wesl` by `cargo xtask docs`: edit that, not this file.

#ifndef LAMPLIGHT_AMBIENT_HEMISPHERE_GLSL
#define LAMPLIGHT_AMBIENT_HEMISPHERE_GLSL

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

/// The share of the sky in the light a tilted surface receives.
///
/// The book calls this cosine form an approximation; it is the exact cosine-weighted share: 0.93301 at 30 degrees, 0.75 at 60, 0.25 at 120.
///
/// Parameters: `n`, `up` unit, one space: the surface's normal and the pole of the sky.
/// Returns: `0.5 + 0.5*n.up`, in [0, 1].
/// Source: Kessenich, Sellers, Shreiner, OpenGL Programming Guide, 9th edition, 2016, example 7.12; Nishita, Nakamae, "Continuous Tone Representation of Three-Dimensional Objects Illuminated by Sky Light", 1986.
/// Edges: 0.5 where `n` or `up` is zero; longer vectors than unit ones are not clamped.
/// Error model: absolute 2^-24 + 0.75*2^-23*sum|n_i*up_i|.
float hemisphere_weight(vec3 n, vec3 up) {
    return 0.5 + 0.5 * dot(n, up);
}

/// The share of the sky in the form the book calls analytic.
///
/// It agrees with `hemisphere_weight` at 0, 90 and 180 degrees only.
///
/// Parameters: `n`, `up` unit, one space: the surface's normal and the pole of the sky.
/// Returns: `1 - 0.5*sin(t)` up to 90 degrees, `0.5*sin(t)` beyond, in [0, 1].
/// Source: Kessenich, Sellers, Shreiner, OpenGL Programming Guide, 9th edition, 2016, "Hemisphere Lighting".
/// Edges: 0.5 on both sides of 90 degrees, where the slope of the formula is 0; 1 where `n` or `up` is zero.
/// Error model: absolute 4*2^-23: the sine is the length of a cross product, which keeps its digits near the pole.
float hemisphere_weight_sine(vec3 n, vec3 up) {
    float half_sine = 0.5 * length(cross(n, up));
    return dot(n, up) >= 0.0 ? 1.0 - half_sine : half_sine;
}

/// Ambient light from sky and ground.
///
/// Parameters: `n`, `up` unit, one space: the surface's normal and the pole of the sky; `sky`, `ground` linear colours, at least 0.
/// Returns: `mix(ground, sky, hemisphere_weight)`, linear, between the two colours.
/// Source: Kessenich, Sellers, Shreiner, OpenGL Programming Guide, 9th edition, 2016, example 7.12.
/// Edges: the mean of both colours where `n` or `up` is zero; `sky` and `ground` are not clamped.
/// Error model: absolute 2*2^-23*|sky - ground| + 2 ULP of the larger colour.
vec3 hemisphere(vec3 n, vec3 up, vec3 sky, vec3 ground) {
    return mix(ground, sky, hemisphere_weight(n, up));
}

/// Ambient light from sky and ground, with the direction to a light as the pole.
///
/// It differs from `hemisphere` in that the pole is a position, so it turns as the point moves.
///
/// Parameters: `n` unit normal; `p` the lit point, scene units, the space of `n`; `light` position of the sky's light, scene units, the space of `n`; `sky`, `ground` linear colours, at least 0.
/// Returns: `mix(ground, sky, 0.5 + 0.5*n.l)` with `l = normalize(light - p)`, linear.
/// Source: Kessenich, Sellers, Shreiner, OpenGL Programming Guide, 9th edition, 2016, example 7.12.
/// Edges: indeterminate where `p` is at `light`; the mean of both colours for a zero `n`; `sky` and `ground` are not clamped.
/// Error model: that of `hemisphere` + 2^-23*(|light| + |p|)/|light - p| of |sky - ground|.
vec3 hemisphere_oglpg(vec3 n, vec3 p, vec3 light, vec3 sky, vec3 ground) {
    return mix(ground, sky, 0.5 + 0.5 * dot(n, normalize(light - p)));
}

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

#endif
