//! Energy of microfacet surfaces: the directional albedo of a lobe, and compensation for multiple scattering between facets.
//!
//! A pair `dfg` has the scale and the offset of the reflectance at normal incidence, in this order: some engines store the offset and the sum.

#ifndef LAMPLIGHT_BRDF_ENERGY_GLSL
#define LAMPLIGHT_BRDF_ENERGY_GLSL

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

/// The light that a microfacet surface reflects of a white environment, in the two parts that depend on the material.
struct SplitSum {
    /// Single scattering: the factor of the environment prefiltered by roughness.
    vec3 single;
    /// Multiple scattering: the factor of the diffuse environment.
    vec3 multiple;
};

/// The directional albedo of GGX with Schlick's Fresnel term, as a scale and an offset of the reflectance at normal incidence.
///
/// Fitted to quadratures of the height-correlated lobe on a grid of 19 roughnesses and 20 cosines.
///
/// Parameters: `nv` cosine n.v, [0, 1]; `roughness` perceptual, [0, 1].
/// Returns: `(scale, offset)`, [0, 1]: the albedo is `f0*scale + f90*offset`.
/// Source: the split: Karis, "Real Shading in Unreal Engine 4", 2013; the coefficients are this library's.
/// Edges: a cosine outside [0, 1] and a roughness outside [0.001, 1] are clamped to it.
/// Error model: absolute 2^-18; the fit is within 0.025 of the albedo for roughness from 0.1 and cosines from 0.05 on, within 0.08 everywhere.
vec2 dfg_approx(float nv, float roughness) {
    float x = clamp(nv, 0.0, 1.0);
    float r = clamp(roughness, 0.001, 1.0);
    float a = r * r;
    float lost = a * (x * (0.23276 - 0.515853 * r + 1.65042 * a - 0.195382 * x) + a * (0.113177 - 0.449665 * r + 0.389169 * a));
    float over = 0.662638 * a * a + x * (a * (0.615166 + 0.752615 * r) + x * (1.0 - 1.29414 * r));
    float albedo = 1.0 - lost / over;
    float y = 1.0 - x;
    float rim = y * y * y * (0.000408534 + r + 1.04599 * a + x * (1.57997 - 4.38461 * r));
    float below = 0.000408534 + 0.995197 * r + a * (4.01817 + 35.8067 * a) + x * (1.52364 - 7.0989 * r + 5.55121 * x);
    float offset = clamp(rim / below, 0.0, 1.0);
    return vec2(clamp(albedo - offset, 0.0, 1.0), offset);
}

/// The factor by which a single-scattering lobe is multiplied so that a white conductor loses nothing.
///
/// Parameters: `f0` linear reflectance at normal incidence, [0, 1]; `dfg` scale and offset of the lobe's albedo.
/// Returns: `1 + f0*(1/(dfg.x + dfg.y) - 1)`, at least 1.
/// Source: Turquin, "Practical Multiple Scattering Compensation for Microfacet Models", 2019, equation 16; Guy, Agopian, "Physically Based Rendering in Filament", section 4.7.2.
/// Edges: an albedo outside [0.05, 1] is clamped to it: no lobe has less.
/// Error model: 6 ULP.
vec3 energy_compensation(vec3 f0, vec2 dfg) {
    float albedo = clamp(dfg.x + dfg.y, 0.05, 1.0);
    return vec3(1.0) + f0 * ((1.0 - albedo) / albedo);
}

/// The split sum with the light that facets reflect several times.
///
/// What both parts leave, `1 - single - multiple`, is for the diffuse colour of a dielectric.
///
/// Parameters: `f0` linear reflectance at normal incidence, [0, 1]; `ks` the reflectance that the scale is for: `f0`, or Schlick's with `max(1 - roughness, f0)` at grazing incidence; `dfg` scale and offset of the lobe's albedo.
/// Returns: the factors of the prefiltered and of the diffuse environment.
/// Source: Fdez-Agüera, "A Multiple-Scattering Microfacet Model for Real-Time Image-Based Lighting", 2019.
/// Edges: an albedo outside [0.05, 1] and an `f0` outside [0, 1] count as the bound; for a white `f0` and `ks` the parts sum up to 1.
/// Error model: absolute 2^-20 for factors up to 1.
SplitSum split_sum_multi(vec3 f0, vec3 ks, vec2 dfg) {
    vec3 single = ks * dfg.x + vec3(dfg.y);
    float lost = 1.0 - clamp(dfg.x + dfg.y, 0.05, 1.0);
    vec3 f = clamp(f0, vec3(0.0), vec3(1.0));
    vec3 average = f + (vec3(1.0) - f) * 0.047619048;
    return SplitSum(single, single * average * lost / (vec3(1.0) - average * lost));
}

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

#endif
