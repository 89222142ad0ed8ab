//! Transmission: what passes a surface, where it goes, and what a volume absorbs of it.
//!
//! Made from `transmission.wesl` by `cargo xtask docs`: edit that, not this file.

#ifndef LAMPLIGHT_BRDF_TRANSMISSION_GLSL
#define LAMPLIGHT_BRDF_TRANSMISSION_GLSL

#include "../math/safe.glsl"
#include "fresnel.glsl"
#include "specular.glsl"

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

/// The reflectance of a dielectric at normal incidence with an artist's weight and colour.
///
/// The reflectance at grazing incidence is the weight. The layer below gets `1 - max(F)` of the light in every channel, with `max(F)` the largest channel of the Fresnel term.
///
/// Parameters: `ior` index of refraction, from 1 on, or 0 for a full reflection; `weight` of the reflection, [0, 1]; `color` linear, at least 0.
/// Returns: `min(f0_from_ior(ior)*color, 1)*weight`, [0, 1].
/// Source: Khronos Group, KHR_materials_specular, 2021, and KHR_materials_ior, 2021.
/// Edges: `weight` itself for an `ior` of 0, as which a negative one counts, and a white `color`; 0 for an `ior` of 1; a `weight` outside [0, 1] is clamped to it; negative colours count as 0.
/// Error model: 9 ULP.
vec3 specular_f0(float ior, float weight, vec3 color) {
    return clamp(f0_from_ior(ior) * color, vec3(0.0), vec3(1.0)) * clamp(weight, 0.0, 1.0);
}

/// The share of light that a volume lets through.
///
/// Parameters: `color` linear colour that white light has after the distance `d`, [0, 1]; `x` length of the path through the volume, scene units; `d` distance at which white light has this colour, scene units.
/// Returns: `color^(x/d)`, [0, 1].
/// Source: Beer's law; Khronos Group, KHR_materials_volume, 2021.
/// Edges: 1 for an `x` or a `d` below 2^-126: such a `d` counts as infinite; a `color` outside [0, 1] is clamped to it; x/d is at most 1e6.
/// Error model: that of `safe_pow` with an exponent of relative error 2^-22.
vec3 volume_transmittance(vec3 color, float x, float d) {
    float e = min(x, d) >= SMALLEST_NORMAL ? x / max(d, x * 1e-6) : 0.0;
    vec3 l = mix(vec3(-1e30), log2(color), greaterThanEqual(color, vec3(SMALLEST_NORMAL)));
    return clamp(exp2(e * l), vec3(0.0), vec3(1.0));
}

/// The way of a refracted view ray to the far side of a body.
///
/// Parameters: `v`, `n` unit, one space, `v` away from the surface, on the side of `n`; `ior` index of refraction, from 1 on; `thickness` length of the way, scene units.
/// Returns: `refract(-v, n, 1/ior)*thickness`, the space of `v`, scene units.
/// Source: Khronos Group, KHR_materials_volume, 2021, as the glTF Sample Viewer reads it.
/// Edges: straight on for an `ior` of 1, or below, which counts as 1; `-n*thickness*sqrt(1 - 1/ior^2)` for a zero `v`, `-v*thickness/ior` for a zero `n`; zero for a `thickness` of 0, and backwards for a negative one.
/// Error model: absolute 8*2^-23*thickness.
vec3 refract_exit(vec3 v, vec3 n, float ior, float thickness) {
    float eta = 1.0 / max(ior, 1.0);
    float along = eta * dot(n, v);
    // 1 - eta^2*(1 - n.v^2), which cancels at the horizon for indices close to 1.
    float inside = sqrt((1.0 - eta) * (1.0 + eta) + along * along);
    return (n * (along - inside) - v * eta) * thickness;
}

/// The roughness that a refraction has: a body that hardly bends light hardly blurs it.
///
/// Parameters: `roughness` perceptual, or alpha, [0, 1]; `ior` index of refraction, from 1 on.
/// Returns: `roughness*saturate(2*ior - 2)`.
/// Source: Khronos Group, glTF Sample Viewer, 2021.
/// Edges: 0 for an `ior` of 1 or below, `roughness` from 1.5 on; `roughness` is not clamped.
/// Error model: 2 ULP.
float transmission_roughness(float roughness, float ior) {
    return roughness * clamp(2.0 * ior - 2.0, 0.0, 1.0);
}

/// Light that passes a thin rough sheet: the specular lobe of the light mirrored to the viewer's side.
///
/// It is to be multiplied by `1 - F` and by the colour of the sheet.
///
/// Parameters: `n`, `l`, `v` unit, one space, away from the surface; `l` on the far side of the sheet; `alpha` squared perceptual roughness, [0, 1].
/// Returns: a BTDF, 1/sr, at least 0: `d_ggx` of the mirrored light with the product of both sides' Smith visibilities.
/// Source: Khronos Group, KHR_materials_transmission, 2021, which has the visibilities separate where the reflection has them correlated.
/// Edges: 0 where the light is on the viewer's side or at the horizon, and where the viewer is behind it, so where `n`, `l` or `v` is zero; 0 for an `alpha` of 0, and a negative one counts as its magnitude; a product of the visibilities' denominators below 1e-12 counts as 1e-12.
/// Error model: relative 2^-17/alpha^2, from the half vector.
float btdf_thin(vec3 n, vec3 l, vec3 v, float alpha) {
    float nl = -dot(n, l);
    float nv = dot(n, v);
    if (!(nl > 0.0 && nv > 0.0)) {
        return 0.0;
    }
    // Both sides are above the surface now, so their sum is not zero.
    vec3 h = normalize_or_zero(l + 2.0 * nl * n + v);
    vec3 across = cross(n, h);
    float a2 = clamp(alpha * alpha, 0.0, 1.0);
    float from_light = nl + sqrt(a2 + (1.0 - a2) * nl * nl);
    float from_view = nv + sqrt(a2 + (1.0 - a2) * nv * nv);
    return min(d_ggx(dot(n, h), dot(across, across), alpha), 1e25) / max(from_light * from_view, 1e-12);
}

/// Three indices of refraction, for the red, green and blue part of a spectrum.
///
/// Parameters: `ior` index of refraction in the middle of the spectrum, from 1 on; `dispersion` 20 over the Abbe number, at least 0.
/// Returns: `(ior - h, ior, ior + h)`, each at least 1, with half the spread `h = (ior - 1)*0.025*dispersion`.
/// Source: Khronos Group, KHR_materials_dispersion, 2024.
/// Edges: red is never below 1; an `ior` below 1 and a negative `dispersion` count as 1 and 0.
/// Error model: 3 ULP.
vec3 dispersion_ior(float ior, float dispersion) {
    float n = max(ior, 1.0);
    float spread = (n - 1.0) * 0.025 * max(dispersion, 0.0);
    return vec3(max(n - spread, 1.0), n, n + spread);
}

/// Light that a rough surface refracts out of a body: the lobe of the facets that bend it towards the viewer.
///
/// It is to be multiplied by `1 - F` and by the colour of the surface. Radiance shrinks as the light leaves a denser body, so the integral over the light's directions is at most `1/ior^2`.
///
/// Parameters: `n`, `l`, `v` unit, one space, away from the surface; `l` on the far side, within the body; `alpha` squared perceptual roughness, [0, 1]; `ior` index of refraction of the body over that of the viewer's side, above 0.
/// Returns: a BTDF, 1/sr, at least 0: `|l.h|*|v.h|/(|n.l|*n.v)*G*D/(ior*l.h + v.h)^2`, with h along `ior*l + v` and the product of both sides' Smith terms for `G`.
/// Source: Walter, Marschner, Li, Torrance, "Microfacet Models for Refraction through Rough Surfaces", 2007, equation 21; Khronos Group, KHR_materials_volume, 2021, has the Smith terms separate.
/// Edges: 0 where the light is on the viewer's side or at the horizon, where the viewer is behind the surface, so where `n`, `l` or `v` is zero, where no facet refracts the one to the other, and for an `alpha` of 0, of which a negative one counts as its magnitude; an `ior` of 1 bends nothing: `btdf_thin` is for it; an `ior` of 0 or below has no meaning, and gives some number of at least 0.
/// Error model: relative 2^-17/alpha^2/(ior - 1)^2, from the half vector.
float btdf_volume(vec3 n, vec3 l, vec3 v, float alpha, float ior) {
    float nl = -dot(n, l);
    float nv = dot(n, v);
    vec3 w = ior * l + v;
    float size2 = dot(w, w);
    // Both sides of the facet, times the length of w: of opposite signs where it refracts.
    float lw = dot(l, w);
    float vw = dot(v, w);
    if (!(nl > 0.0 && nv > 0.0 && lw * vw < 0.0)) {
        return 0.0;
    }
    vec3 h = w * (sign(vw) / sqrt(size2));
    float nh = dot(n, h);
    if (!(nh > 0.0)) {
        return 0.0;
    }
    vec3 across = cross(n, h);
    float a2 = clamp(alpha * alpha, 0.0, 1.0);
    float from_light = nl + sqrt(a2 + (1.0 - a2) * nl * nl);
    float from_view = nv + sqrt(a2 + (1.0 - a2) * nv * nv);
    // The product of the squared sizes would overflow for long vectors.
    float shrink = 1.0 / max(size2, 1e-15);
    float spread = -4.0 * (lw * shrink) * (vw * shrink);
    float lobe = spread * min(d_ggx(nh, dot(across, across), alpha), 1e25) / max(from_light * from_view, 1e-12);
    return min(lobe, 1e38);
}

/// `volume_transmittance` without guards.
///
/// Parameters: `color` linear colour that white light has after the distance `d`, above 0, up to 1; `x` length of the path through the volume, scene units, at least 0; `d` distance at which white light has this colour, scene units, above 0.
/// Returns: `color^(x/d)`, [0, 1].
/// Source: as `volume_transmittance`.
/// Edges: 1 for an `x` of 0; only for a `color` and a `d` from 1e-30 on: elsewhere it may have no value.
/// Error model: that of `volume_transmittance`.
vec3 volume_transmittance_fast(vec3 color, float x, float d) {
    return exp2(log2(color) * (x / d));
}

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

#endif
