//! A clear coat: a thin dielectric layer over another material.
//!
//! Made from `coat.wesl` by `cargo xtask docs`: edit that, not this file.

#ifndef LAMPLIGHT_BRDF_COAT_GLSL
#define LAMPLIGHT_BRDF_COAT_GLSL

#include "fresnel.glsl"

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

/// The light of a coated surface: what the coat reflects, and what the base does below it.
///
/// Parameters: `base`, `coat` linear light of the base and of the coat's highlight without its Fresnel term; `cc` strength of the coat, [0, 1]; `fr` the coat's reflectance towards the viewer, [0, 1]: for an index of 1.5 `0.04 + 0.96*(1 - nv)^5`.
/// Returns: `mix(base, coat, cc*fr)`.
/// Source: Khronos Group, KHR_materials_clearcoat, 2020.
/// Edges: `base` where `cc` or `fr` is 0; the share `cc*fr` is clamped to [0, 1], its factors and the colours `base` and `coat` are not.
/// Error model: absolute 3*2^-23*(|base| + |coat|).
vec3 coat_mix(vec3 base, vec3 coat, float cc, float fr) {
    float share = clamp(cc * fr, 0.0, 1.0);
    return base * (1.0 - share) + coat * share;
}

/// The reflectance at normal incidence that a base has towards a coat instead of air.
///
/// Parameters: `f0` linear reflectance of the base in air, [0, 1]; `ior` index of refraction of the coat, at least 0, 1.5 for lacquer.
/// Returns: `((A + B*sqrt(f0))/(B + A*sqrt(f0)))^2` with `A = 1 - ior`, `B = 1 + ior`, [0, 1].
/// Source: Fresnel's equation at normal incidence, for the index of `ior_from_f0` divided by the coat's index; Guy, Agopian, "Physically Based Rendering in Filament", section 4.9.4 "Base layer modification", has the case of 1.5.
/// Edges: `f0` for an `ior` of 1; an `f0` outside [0, 1] is clamped to it; a negative `ior` counts as 0, which gives 1.
/// Error model: absolute 16*2^-23.
vec3 coat_f0(vec3 f0, float ior) {
    vec3 s = sqrt(clamp(f0, vec3(0.0), vec3(1.0)));
    float n = max(ior, 0.0);
    vec3 r = (vec3(1.0) + s - n * (vec3(1.0) - s)) / (vec3(1.0) + s + n * (vec3(1.0) - s));
    return r * r;
}

/// The factor by which a coat darkens and saturates the base: light that the base reflects may be reflected back to it from within the coat.
///
/// Parameters: `eb` linear albedo of the base without a coat, [0, 1]; `eta` index of refraction of the coat over that of the air, from 1 on; `rb` perceptual roughness of the base, [0, 1]: how evenly its light is spread; `f` reflectance of the coat for the angle of the view, [0, 1].
/// Returns: `(1 - K)/(1 - eb*K)`, [0, 1], with `K = mix(f, 1 - (1 - E)/eta^2, rb)` and `E` the average reflectance of the coat from above.
/// Source: Academy Software Foundation, OpenPBR Surface 1.1, 2024, "Coat darkening".
/// Edges: 1 for a white base and for a coat that reflects nothing; parameters outside their ranges are clamped to them, and an `eta` above 100 counts as 100; what `1 - K` is at least, 0.0001, keeps a white base white below a coat that reflects everything.
/// Error model: relative 2^-20.
vec3 coat_darkening(vec3 eb, float eta, float rb, float f) {
    float n = clamp(eta, 1.0, 100.0);
    float diffuse = (1.0 - f_average_dielectric(n)) / (n * n);
    // 1 - K, which is what leaves the coat at each of its bounces.
    float leaving = max(mix(1.0 - clamp(f, 0.0, 1.0), diffuse, clamp(rb, 0.0, 1.0)), 1e-4);
    vec3 absorbed = 1.0 - clamp(eb, vec3(0.0), vec3(1.0));
    return leaving / (leaving + (1.0 - leaving) * absorbed);
}

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

#endif
