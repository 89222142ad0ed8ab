//! Subsurface scattering by normalised diffusion: the distance between the points where light enters and leaves a body.
//!
//! Made from `subsurface.wesl` by `cargo xtask docs`: edit that, not this file.

#ifndef LAMPLIGHT_BRDF_SUBSURFACE_GLSL
#define LAMPLIGHT_BRDF_SUBSURFACE_GLSL

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

/// The profile of normalised diffusion.
///
/// Parameters: `r` distance on the surface, scene units, at least 0; `s` the result of `diffusion_s` divided by the mean free path, 1/scene unit, above 0.
/// Returns: `s*(exp(-s*r) + exp(-s*r/3))/(8*pi*r)`, 1/scene unit^2: its integral over the plane is 1.
/// Source: Christensen, Burley, "Approximate Reflectance Profiles for Efficient Subsurface Scattering", 2015.
/// Edges: a product `s*r` below 0.0001 counts as 0.0001, so the peak is finite; a negative `r` counts as 0, `s` is clamped to [0, 1e6]; 0 for an `s` of 0 or below.
/// Error model: relative (8 + 2*s*r)*2^-23.
float diffusion_profile(float r, float s) {
    float k = clamp(s, 0.0, 1e6);
    float x = max(k * r, 1e-4);
    return k * k * (exp(-x) + exp(-x / 3.0)) / x * 0.039788736;
}

/// The share of light that leaves a body within a distance of the point where it entered.
///
/// Parameters: `r` distance on the surface, scene units, at least 0; `s` as for `diffusion_profile`.
/// Returns: `1 - exp(-s*r)/4 - 3*exp(-s*r/3)/4`, [0, 1].
/// Source: Christensen, Burley, "Approximate Reflectance Profiles for Efficient Subsurface Scattering", 2015.
/// Edges: 0 where the product of `s` and `r` is 0 or below; neither is clamped.
/// Error model: absolute 4*2^-23.
float diffusion_cdf(float r, float s) {
    float x = max(s * r, 0.0);
    return 1.0 - 0.25 * exp(-x) - 0.75 * exp(-x / 3.0);
}

/// The factor that fits normalised diffusion to a surface's albedo, for light that enters in one direction.
///
/// Parameters: `albedo` linear albedo of the surface, [0, 1].
/// Returns: `1.85 - A + 7*|A - 0.8|^3`, to be divided by the mean free path.
/// Source: Christensen, Burley, "Approximate Reflectance Profiles for Efficient Subsurface Scattering", 2015, equation 5, for light that enters in one direction (a searchlight). The paper has other fits for diffuse light and for the diffuse mean free path.
/// Edges: an albedo outside [0, 1] is clamped to it.
/// Error model: 4 ULP.
vec3 diffusion_s(vec3 albedo) {
    vec3 a = clamp(albedo, vec3(0.0), vec3(1.0));
    vec3 x = abs(a - vec3(0.8));
    return vec3(1.85) - a + 7.0 * x * x * x;
}

/// A distance at which light leaves a body, distributed as the profile of normalised diffusion.
///
/// Parameters: `u` a random number, [0, 1]; `s` as for `diffusion_profile`, above 0.
/// Returns: the distance for which `diffusion_cdf` is `u`, scene units, at least 0.
/// Source: Golubev, "Efficient Screen-Space Subsurface Scattering Using Burley's Normalized Diffusion in Real-Time", SIGGRAPH, 2018: with `y = exp(-s*r/3)` the equation is the cubic `y^3 + 3*y = 4*(1 - u)`.
/// Edges: a `u` outside [0, 1 - 2^-24] is clamped to it, for which `s*r` is 49; an `s` below 1e-6 counts as 1e-6.
/// Error model: absolute 2^-20/s, relative 2^-20.
float diffusion_sample(float u, float s) {
    float g = 2.0 * max(1.0 - max(u, 0.0), 5.9604645e-8);
    // Cardano's root cancels near 0; one step of Newton gives back its digits.
    float t = pow(g + sqrt(g * g + 1.0), 0.33333333);
    float root = t - 1.0 / t;
    float y = (2.0 * root * root * root + 2.0 * g) / (3.0 * root * root + 3.0);
    return max(-3.0 * log(y), 0.0) / max(s, 1e-6);
}

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

#endif
