//! Anisotropic microfacet terms, and geometric specular antialiasing.
//!
//! Cosines are named by their two directions: `th` is the tangent's and the half vector's, `bv` the bitangent's and the viewer's.
//!
//! Made from `microfacet.wesl` by `cargo xtask docs`: edit that, not this file.

#ifndef LAMPLIGHT_BRDF_MICROFACET_GLSL
#define LAMPLIGHT_BRDF_MICROFACET_GLSL

#include "../math/safe.glsl"

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

/// The GGX distribution of microfacet normals with one roughness along the tangent and one along the bitangent.
///
/// Parameters: `th`, `bh`, `nh` cosines t.h, b.h and n.h, [-1, 1], the last at least 0; `at`, `ab` alpha along the tangent and the bitangent, [0, 1].
/// Returns: `1/(pi*at*ab*s^2)` with `s = (th/at)^2 + (bh/ab)^2 + nh^2`, 1/sr, at least 0; `d_ggx` where both alphas are the same.
/// Source: Burley, "Physically-Based Shading at Disney", 2012, appendix B.2, equation 13.
/// Edges: 0 where `at` or `ab` is 0 or below, the mirror direction included; a product of both below 1e-16 makes the value smaller; `s` is 1 or more for unit vectors, and counts as 1 where it is less; `th`, `bh` and `nh` count as their magnitudes.
/// Error model: 20 ULP.
float d_ggx_aniso(float th, float bh, float nh, float at, float ab) {
    // Everything times (at*ab)^2: one division is enough.
    float a2 = max(at, 0.0) * max(ab, 0.0);
    vec3 w = vec3(ab * th, at * bh, a2 * nh);
    float narrow = a2 / max(dot(w, w), a2 * a2 + SMALLEST_NORMAL);
    return 0.31830989 * a2 * narrow * narrow;
}

/// The height-correlated Smith visibility of GGX with two roughnesses, divided by 4*nl*nv.
///
/// It is 1/4 or more, and has no upper bound: implementations that clamp it to 1 lose most of the light at grazing angles.
///
/// Parameters: `tv`, `bv`, `nv` cosines t.v, b.v and n.v; `tl`, `bl`, `nl` those of the light, [-1, 1]; `at`, `ab` alpha along the tangent and the bitangent, [0, 1].
/// Returns: `0.5/(nl*|(at*tv, ab*bv, nv)| + nv*|(at*tl, ab*bl, nl)|)`, at least 0; `v_smith_ggx` where both alphas are the same.
/// Source: Heitz, "Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs", 2014, equations 86 and 99.
/// Edges: 0 where `nv` or `nl` is 0 or below: the light or the viewer is at or behind the horizon; `tv`, `bv`, `tl`, `bl`, `at` and `ab` count as their magnitudes, and are not clamped; a denominator below 2^-126 counts as that.
/// Error model: 14 ULP.
float v_smith_ggx_aniso(float tv, float bv, float nv, float tl, float bl, float nl, float at, float ab) {
    float from_view = length(vec3(at * tv, ab * bv, nv));
    float from_light = length(vec3(at * tl, ab * bl, nl));
    float visibility = 0.5 / (nl * from_view + (nv * from_light + SMALLEST_NORMAL));
    return min(nv, nl) > 0.0 ? visibility : 0.0;
}

/// The two alphas of a surface that is brushed along its tangent.
///
/// Parameters: `alpha` squared perceptual roughness, [0, 1]; `strength` of the anisotropy, [0, 1].
/// Returns: alpha along the tangent, `mix(alpha, 1, strength^2)`, and along the bitangent, `alpha`.
/// Source: Khronos Group, KHR_materials_anisotropy, 2023.
/// Edges: parameters outside [0, 1] are clamped to it.
/// Error model: 3 ULP.
vec2 alpha_aniso(float alpha, float strength) {
    float a = clamp(alpha, 0.0, 1.0);
    float s = max(strength, 0.0);
    return vec2(a + (1.0 - a) * clamp(s * s, 0.0, 1.0), a);
}

/// Geometric specular antialiasing: alpha grows where the normal changes within a pixel, so that highlights do not flicker.
///
/// Parameters: `alpha` squared perceptual roughness, [0, 1]; `dx`, `dy` change of the unit normal from this pixel to the next, across and down; `sigma2` variance of the pixel's filter, pixels^2, at least 0: 0.25 or 1/(2*pi), by publication; `limit` largest number that is added to alpha squared, 0.18 in the source.
/// Returns: `sqrt(alpha^2 + min(2*sigma2*(dx.dx + dy.dy), limit))`, [0, 1].
/// Source: Tokuyoshi, Kaplanyan, "Improved Geometric Specular Antialiasing", 2019.
/// Edges: `alpha` itself for a flat surface, where `dx` and `dy` are zero, and for a `sigma2` or `limit` of 0; negative ones make it smaller; a negative `alpha` counts as its magnitude; sums outside [0, 1] are clamped to it.
/// Error model: 8 ULP.
float specular_aa(float alpha, vec3 dx, vec3 dy, float sigma2, float limit) {
    float added = min(2.0 * sigma2 * (dot(dx, dx) + dot(dy, dy)), limit);
    return sqrt(clamp(alpha * alpha + added, 0.0, 1.0));
}

/// The direction in which a brushed surface mirrors its surroundings, for a lookup in an environment that knows one roughness.
///
/// The normal is bent towards the plane of the tangent and the viewer's mirror image.
///
/// Parameters: `v`, `n` unit, one space, `v` away from the surface; `b` unit bitangent, that space; `strength` of the anisotropy, [0, 1]; `roughness` perceptual, [0, 1].
/// Returns: unit direction, that space: `reflect(-v, normalize(mix(bent, n, (1 - strength*(1 - roughness))^4)))`, with `bent` the part of `v` across `b`.
/// Source: Khronos Group, KHR_materials_anisotropy, 2023: image-based lighting.
/// Edges: where `v` is along `b`, or the mixture is zero, as for an isotropic surface; parameters outside [0, 1] are clamped to it; zero for a zero `v`; for a zero `b`, `bent` is along `v`.
/// Error model: absolute 16*2^-23/|v - b*(b.v)|.
vec3 bent_reflection(vec3 v, vec3 n, vec3 b, float strength, float roughness) {
    vec3 bent = safe_normalize(v - b * dot(b, v), n);
    float x = 1.0 - clamp(strength, 0.0, 1.0) * (1.0 - clamp(roughness, 0.0, 1.0));
    float share = x * x * x * x;
    return reflect(-v, safe_normalize(bent + (n - bent) * share, n));
}

/// The two alphas of a brushed surface as Filament has them.
///
/// It differs from `alpha_aniso` in that the highlight gets narrower across the tangent while it gets wider along it.
///
/// Parameters: `alpha` squared perceptual roughness, [0, 1]; `strength` of the anisotropy, [-1, 1], below 0 along the bitangent.
/// Returns: alpha along the tangent, `alpha*(1 + strength)`, and along the bitangent, `alpha*(1 - strength)`; [0, 2].
/// Source: Guy, Agopian, "Physically Based Rendering in Filament", section 4.10.1.
/// Edges: parameters outside their ranges are clamped; one alpha is 0 at the ends of the strength, where `d_ggx_aniso` is 0.
/// Error model: 2 ULP.
vec2 alpha_aniso_filament(float alpha, float strength) {
    float a = clamp(alpha, 0.0, 1.0);
    float s = clamp(strength, -1.0, 1.0);
    return vec2(a * (1.0 + s), a * (1.0 - s));
}

/// The two alphas of a brushed surface as Disney's BRDF has them.
///
/// It differs from `alpha_aniso` in that the product of both alphas stays the same, and in that no strength makes the highlight longer than ten times its width.
///
/// Parameters: `alpha` squared perceptual roughness, [0, 1]; `strength` of the anisotropy, [0, 1].
/// Returns: alpha along the tangent, `alpha/aspect`, and along the bitangent, `alpha*aspect`, with `aspect = sqrt(1 - 0.9*strength)`; [0, 3.2].
/// Source: Burley, "Physically-Based Shading at Disney", 2012, section 5.4.
/// Edges: parameters outside [0, 1] are clamped to it.
/// Error model: 24 ULP: an aspect of a strength near 1 has lost some digits.
vec2 alpha_aniso_disney(float alpha, float strength) {
    float a = clamp(alpha, 0.0, 1.0);
    float aspect = sqrt(1.0 - 0.9 * clamp(strength, 0.0, 1.0));
    return vec2(a / aspect, a * aspect);
}

/// The two alphas of a brushed surface as OpenPBR has them.
///
/// It differs from `alpha_aniso` in that the mean of both squares stays that of `alpha`.
///
/// Parameters: `alpha` squared perceptual roughness, [0, 1]; `strength` of the anisotropy, [0, 1].
/// Returns: alpha along the tangent, `alpha*sqrt(2/(1 + (1 - strength)^2))`, and along the bitangent, `1 - strength` times that; [0, 1.42].
/// Source: Academy Software Foundation, OpenPBR Surface specification 1.1, 2024, "Microfacet model".
/// Edges: parameters outside [0, 1] are clamped to it; the second alpha is 0 for a strength of 1, where `d_ggx_aniso` is 0.
/// Error model: 10 ULP.
vec2 alpha_aniso_openpbr(float alpha, float strength) {
    float share = 1.0 - clamp(strength, 0.0, 1.0);
    float along = clamp(alpha, 0.0, 1.0) * sqrt(2.0 / (1.0 + share * share));
    return vec2(along, share * along);
}

/// Kelemen's visibility, a cheap one for smooth coats.
///
/// Parameters: `lh` cosine l.h, [0, 1].
/// Returns: `1/(4*lh^2)`, at least 0.25.
/// Source: Kelemen, Szirmay-Kalos, "A Microfacet Based Coupled Specular-Matte BRDF Model with Importance Sampling", 2001; Filament uses it for its clear coat.
/// Edges: never above 2.2e37, which it is for an `lh` of 0.
/// Error model: 4 ULP.
float v_kelemen(float lh) {
    return 0.25 / (lh * lh + SMALLEST_NORMAL);
}

/// A normal of a GGX surface's facets, as often as the viewer sees it.
///
/// Mirror the viewer at it, `reflect(-v, h)`, for a direction of light. Its weight is then `F*G2/G1`: Fresnel's term, and `4*V*nl*nv` over the masking of the viewer alone.
///
/// Parameters: `v` unit, towards the viewer, z along the normal, at least 0; `at`, `ab` alpha along x and y, [0, 1]; `u` two independent numbers in [0, 1).
/// Returns: unit vector, z at least 0.
/// Source: Dupuy, Benyoub, "Sampling Visible GGX Normals with Spherical Caps", 2023, listing 3, with the azimuth `2*pi*(u.x - 1/2)`.
/// Edges: the normal where `at` and `ab` are 0, and where the sum of the facet and the viewer is zero; negative ones mirror the sample; a `v` below the horizon counts as one at it, a zero one as the normal; a facet at the horizon where the second number of `u` is above 1; the first is a turn, and may be any number.
/// Error model: absolute 2^-9*max(at, ab)/(1 - u.y): the sine and cosine may be off by 2^-11.
vec3 sample_ggx_visible(vec3 v, float at, float ab, vec2 u) {
    vec3 up = vec3(0.0, 0.0, 1.0);
    vec3 w = safe_normalize(vec3(at * v.x, ab * v.y, max(v.z, 0.0)), up);
    float phi = 6.2831853 * (u.x - 0.5);
    // The directions that the stretched surface mirrors to the viewer fill a cap of the sphere.
    float z = (1.0 - u.y) * (1.0 + w.z) - w.z;
    float r = sqrt(max(1.0 - z * z, 0.0));
    vec3 h = vec3(r * cos(phi), r * sin(phi), z) + w;
    return safe_normalize(vec3(at * h.x, ab * h.y, max(h.z, 0.0)), up);
}

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

#endif
