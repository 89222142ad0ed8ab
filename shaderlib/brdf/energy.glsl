//! Energy of microfacet surfaces: the directional albedo of a lobe, and compensation for multiple scattering between facets.
//!
//! A pair `dfg` has the scale and the offset of the reflectance at normal incidence, in this order: some engines store the offset and the sum.
//!
//! Made from `energy.wesl` by `cargo xtask docs`: edit that, not this file.

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
/// Quotients of polynomials, fitted to quadratures of the height-correlated lobe: `cargo xtask fit`.
///
/// Parameters: `nv` cosine n.v, [0, 1]; `roughness` perceptual, [0, 1].
/// Returns: `(scale, offset)`, [0, 1]: the albedo is `f0*scale + f90*offset`.
/// Source: the split: Karis, "Real Shading in Unreal Engine 4", 2013; the coefficients are this library's.
/// Edges: an `nv` outside [0, 1] and a `roughness` outside [0.001, 1] are clamped to it.
/// Error model: absolute 2^-20; for roughness from 0.05 and cosines from 0.01 on, both numbers are within 0.005 of those of the lobe, and their sum is within 0.4 % of its own; everywhere, both are within 0.026, and the sum is within 0.009.
vec2 dfg_approx(float nv, float roughness) {
    float x = clamp(nv, 0.0, 1.0);
    float r = clamp(roughness, 0.001, 1.0);
    float a = r * r;
    float u = r * sqrt(x);
    float lost = a * (u * (0.584869 + 2.75245 * a * a) - 0.0977434 * x - a * (0.0749448 + 0.059179 * a * a));
    float over = x * x * (1.0 + a * (0.373359 * u - 2.4634)) + a * (x * (1.33161 + 3.50483 * a) - 3.83077 * u + a * (5.44816 + a * (2.15307 * a - 3.04355)));
    float albedo = min(1.0 - lost / over, 1.0);
    float y = 1.0 - x;
    float rim = a * (0.0406518 - 1.51886 * r - 6.45071 * a + 4.0002 * x * x);
    float below = x - 0.395461 * u + a * (1.16293 + 7.21068 * a);
    float offset = min(y * y * y * y * y * (albedo + albedo * rim / below), albedo);
    return vec2(albedo - offset, offset);
}

/// The factor by which a single-scattering lobe is multiplied so that a white conductor loses nothing.
///
/// Parameters: `f0` linear reflectance at normal incidence, [0, 1]; `dfg` scale and offset of the lobe's albedo.
/// Returns: `1 + f0*(1/(dfg.x + dfg.y) - 1)`, at least 1.
/// Source: Turquin, "Practical Multiple Scattering Compensation for Microfacet Models", 2019, equation 16; Guy, Agopian, "Physically Based Rendering in Filament", section 4.7.2.
/// Edges: a sum of `dfg` outside [0.05, 1] is clamped to it: no lobe has a smaller albedo; 1 for a black `f0`, and less than 1 for a negative one.
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
/// Edges: a sum of `dfg` outside [0.05, 1] and an `f0` outside [0, 1] count as the nearer bound, `ks` is not clamped; for a white `f0` and `ks` the parts sum up to 1.
/// Error model: absolute 2^-20 for factors up to 1.
SplitSum split_sum_multi(vec3 f0, vec3 ks, vec2 dfg) {
    vec3 single = ks * dfg.x + vec3(dfg.y);
    float lost = 1.0 - clamp(dfg.x + dfg.y, 0.05, 1.0);
    vec3 f = clamp(f0, vec3(0.0), vec3(1.0));
    vec3 average = f + (vec3(1.0) - f) * 0.047619048;
    return SplitSum(single, single * average * lost / (vec3(1.0) - average * lost));
}

/// The lobe of the light that facets reflect several times, which a single-scattering lobe leaves out.
///
/// Parameters: `eo`, `ei` albedo of the white single-scattering lobe towards the viewer and the light, [0, 1]; `eavg` its average over the hemisphere, weighted by the cosine, [0, 1]; `favg` linear average of the Fresnel term, [0, 1].
/// Returns: `(1 - eo)*(1 - ei)/(pi*(1 - eavg))*favg^2*eavg/(1 - favg*(1 - eavg))`, 1/sr, at least 0; the caller multiplies by `nl`.
/// Source: Kulla, Conty, "Revisiting Physically Based Shading at Imageworks", 2017. Texts with one factor `favg` count the first reflection too.
/// Edges: 0 where the lobe loses nothing; an `eavg` outside [0.05, 0.9999] and other parameters outside [0, 1] are clamped to it.
/// Error model: relative 2^-20, absolute 2^-20 over `1 - eavg`.
vec3 ms_lobe(float eo, float ei, float eavg, vec3 favg) {
    float kept = clamp(eavg, 0.05, 0.9999);
    float lost = 1.0 - kept;
    vec3 f = clamp(favg, vec3(0.0), vec3(1.0));
    float shape = (1.0 - clamp(eo, 0.0, 1.0)) * (1.0 - clamp(ei, 0.0, 1.0)) * 0.31830989 / lost;
    return shape * (f * f * kept / (1.0 - f * lost));
}

/// The directional albedo of GGX by the fit of MaterialX.
///
/// Parameters: `nv` cosine n.v, [0, 1]; `roughness` perceptual, [0, 1].
/// Returns: `(scale, offset)` as `dfg_approx`, [0, 1]; their sum may be 0.05 above 1.
/// Source: Hill, in MaterialX, `mx_ggx_dir_albedo_analytic` of `mx_microfacet_specular.glsl`, for alpha. It is fitted to the height-correlated lobe.
/// Edges: parameters outside [0, 1] are clamped to it.
/// Error model: absolute 2^-18; both numbers are within 0.07 of those of the height-correlated lobe for roughness from 0.1 and cosines from 0.05 on.
vec2 dfg_approx_hill(float nv, float roughness) {
    float x = clamp(nv, 0.0, 1.0);
    float r = clamp(roughness, 0.0, 1.0);
    float y = r * r;
    float x2 = x * x;
    float y2 = y * y;
    vec4 q = vec4(0.1003, 0.9345, 1.0, 1.0)
        + vec4(-0.6303, -2.323, -1.765, 0.2281) * x + vec4(9.748, 2.229, 8.263, 15.94) * y
        + vec4(-2.038, -3.748, 11.53, -55.83) * x * y
        + vec4(29.34, 1.424, 28.96, 13.08) * x2 + vec4(-8.245, -0.7684, -7.507, 41.26) * y2
        + vec4(-26.44, 1.436, -36.11, 54.9) * x2 * y + vec4(19.99, 0.2913, 15.86, 300.2) * x * y2
        + vec4(-5.448, 0.6286, 33.37, -285.1) * x2 * y2;
    return clamp(q.xy / q.zw, vec2(0.0), vec2(1.0));
}

/// The directional albedo of GGX by the fit that mobile versions of Unreal use.
///
/// Parameters: `nv` cosine n.v, [0, 1]; `roughness` perceptual, [0, 1].
/// Returns: `(scale, offset)` as `dfg_approx`; an offset of a smooth surface may be 0.04 below 0.
/// Source: Karis, "Physically Based Shading on Mobile", 2014, after Lazarov. Its geometry term is not the height-correlated one.
/// Edges: parameters outside [0, 1] are clamped to it.
/// Error model: absolute 2^-20; both numbers are within 0.2 of those of the height-correlated lobe for roughness from 0.3 to 0.7 and cosines from 0.2 on.
vec2 dfg_approx_karis(float nv, float roughness) {
    float r = clamp(roughness, 0.0, 1.0);
    vec4 q = r * vec4(-1.0, -0.0275, -0.572, 0.022) + vec4(1.0, 0.0425, 1.04, -0.04);
    float a = min(q.x * q.x, exp2(-9.28 * clamp(nv, 0.0, 1.0))) * q.x + q.y;
    return vec2(-1.04, 1.04) * a + q.zw;
}

/// The directional albedo of GGX by a polynomial over glossiness.
///
/// Engines give it `1 - roughness`, as here, although the lobe that it fits best has an alpha of `roughness^4`: a surface seems smoother than it is, by up to 0.26 of the albedo.
///
/// Parameters: `nv` cosine n.v, [0, 1]; `roughness` perceptual, [0, 1].
/// Returns: `(scale, offset)` as `dfg_approx`; the offset is in [0, 1], and so is the sum of both, but for rounding.
/// Source: Lazarov, "Getting More Physical in Call of Duty: Black Ops II", 2013, in the form for glossiness `1 - roughness` of Knarkowicz, "Analytical DFG Term for IBL", 2014. Its geometry term is not the height-correlated one.
/// Edges: parameters outside [0, 1] are clamped to it.
/// Error model: absolute 2^-19; for the square root of the roughness in its place, both numbers are within 0.09 of those of the height-correlated lobe for roughness from 0.16 to 0.72 and cosines from 0.2 on.
vec2 dfg_approx_lazarov(float nv, float roughness) {
    float y = clamp(nv, 0.0, 1.0);
    float g = 1.0 - clamp(roughness, 0.0, 1.0);
    float smooth_side = g * (1.895 * g - 0.1688);
    float rough_side = 0.9903 + y * (-4.853 + y * (8.404 - 5.069 * y));
    float bias = clamp(min(smooth_side, rough_side), 0.0, 1.0);
    float total = 0.6045 + g * (1.699 + g * (2.661 * g - 3.603)) + y * (0.1939 * y - 0.5228 + 1.404 * g);
    return vec2(clamp(total, 0.0, 1.0) - bias, bias);
}

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

#endif
