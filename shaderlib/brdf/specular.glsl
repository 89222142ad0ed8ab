//! Highlights: the classic lobes, and the terms of a microfacet BRDF (`d_ggx * v_smith_ggx * f_schlick`).
//!
//! Made from `specular.wesl` by `cargo xtask docs`: edit that, not this file.

#ifndef LAMPLIGHT_BRDF_SPECULAR_GLSL
#define LAMPLIGHT_BRDF_SPECULAR_GLSL

#include "../math/safe.glsl"

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

/// Phong's lobe around the mirrored light.
///
/// Parameters: `n`, `l`, `v` unit, one space, `l` and `v` away from the surface; `s` shininess, at least 0.
/// Returns: `max(r.v, 0)^s` with `r = reflect(-l, n)`, in [0, 1]; 0 where `n.l <= 0`.
/// Source: Phong, "Illumination for Computer Generated Pictures", 1975.
/// Edges: 0 where the light is at or behind the horizon, so where `n` or `l` is zero; 1 in front for an `s` of 0, and a negative `s` counts as 0; 0 for a zero `v` and an `s` above 0.
/// Error model: relative `s*ln2*2^-21 + |t|*ln2*u + (3 + 2|t|)*u + s*rel(r.v)`, t = s*log2(r.v), u = 2^-23; r.v has absolute error 2^-20.
float phong(vec3 n, vec3 l, vec3 v, float s) {
    float power = cosine_power(dot(reflect(-l, n), v), s);
    return dot(n, l) > 0.0 ? power : 0.0;
}

/// Phong's lobe as the book's shadow example computes it.
///
/// It differs from `phong` in that the maximum comes after the power, so a negative base gives an indeterminate value,
/// and in that nothing is gated by n.l, so a highlight shows on the far side of the surface. The book writes
/// `dot(-E, R)` with `E` from the eye to the point: that is `v` here.
///
/// Parameters: `n` unit at the vertices, as interpolated and not normalised again; `l`, `v` unit, the space of `n`, away from the surface; `s` shininess, at least 0.
/// Returns: `max(pow(r.v, s), 0)` with `r = reflect(-l, n)`, at least 0 where r.v is above 0.
/// Source: Kessenich, Sellers, Shreiner, OpenGL Programming Guide, 9th edition, 2016, example 7.21.
/// Edges: indeterminate where r.v is below 0, and at 0 for an `s` of 0 or below; r.v is 0 where `l` or `v` is zero, and r is `-l` for a zero `n`.
/// Error model: that of `phong` where r.v is above 0, none elsewhere.
float phong_oglpg_7_21(vec3 n, vec3 l, vec3 v, float s) {
    return max(pow(dot(v, reflect(-l, n)), s), 0.0);
}

/// Phong's lobe as Igalia's tutorial computes it.
///
/// It differs from `phong` in that a light on the horizon still reflects, and in what the tutorial passes as `l`:
/// the reversed axis of the spot light, for every fragment.
///
/// Parameters: `n`, `l`, `v` unit, one space, `l` and `v` away from the surface; `s` shininess, above 0.
/// Returns: `max(r.v, 0)^s` where `n.l >= 0`, else 0; in [0, 1].
/// Source: Igalia, "Working with lights and shadows", part I, Phong reflection model.
/// Edges: lit at n.l = 0 exactly, so for a zero `n`, where r is `-l`; 0 where `l` or `v` is zero and `s` is above 0; indeterminate for an `s` of 0 or below with r.v at or below 0.
/// Error model: that of `phong`.
float phong_igl(vec3 n, vec3 l, vec3 v, float s) {
    if (!(dot(n, l) >= 0.0)) {
        return 0.0;
    }
    return pow(max(dot(reflect(-l, n), v), 0.0), s);
}

/// Blinn's lobe with the half vector given.
///
/// Parameters: `n`, `h` unit, one space; `n_dot_l` cosine n.l, [-1, 1]; `s` shininess, at least 0.
/// Returns: `max(n.h, 0)^s`, in [0, 1]; 0 where `n_dot_l <= 0`.
/// Source: Kessenich, Sellers, Shreiner, OpenGL Programming Guide, 9th edition, 2016, example 7.3: the half vector is a uniform, the highlight is 0 where the diffuse term is.
/// Edges: 0 where `n_dot_l` is 0 or below: the light is at or behind the horizon; 1 in front for an `s` of 0, and a negative `s` counts as 0; 0 where `n` or `h` is zero and `s` is above 0.
/// Error model: that of `safe_pow(n.h, s)`; n.h has absolute error 3*2^-23.
float blinn_phong_half(vec3 n, vec3 h, float n_dot_l, float s) {
    return n_dot_l > 0.0 ? cosine_power(dot(n, h), s) : 0.0;
}

/// Blinn's lobe around the half vector.
///
/// Parameters: `n`, `l`, `v` unit, one space, `l` and `v` away from the surface; `s` shininess, at least 0.
/// Returns: `max(n.h, 0)^s` with `h = normalize(l + v)`, in [0, 1]; 0 where `n.l <= 0`.
/// Source: Blinn, "Models of Light Reflection for Computer Synthesized Pictures", 1977.
/// Edges: 0 where the light is at or behind the horizon, so where `n` or `l` is zero; the half vector of `l = -v` is zero, so the result is 0 but for an `s` of 0; a negative `s` counts as 0; the half vector of a zero `v` is `l`.
/// Error model: relative `s*ln2*2^-21 + |t|*ln2*u + (3 + 2|t|)*u + s*rel(n.h)`, t = s*log2(n.h), u = 2^-23; n.h has absolute error 12*2^-23/|l + v|.
float blinn_phong(vec3 n, vec3 l, vec3 v, float s) {
    return blinn_phong_half(n, normalize_or_zero(l + v), dot(n, l), s);
}

/// Blinn's lobe as the recipe computes it.
///
/// It differs from `blinn_phong` in that the maximum comes after the power, so a negative base gives an indeterminate
/// value, and in that nothing is gated by n.l, so a highlight shows on the far side of the surface.
///
/// Parameters: `n`, `l`, `v` unit, one space, `l` and `v` away from the surface; `s` shininess, at least 0.
/// Returns: `max(0, pow(n.h, s))` with `h = normalize(l + v)`, in [0, 1] where n.h is above 0.
/// Source: Movania et al., OpenGL: Build High Performance Graphics, 2017, chapter 4, per-vertex and per-fragment lighting.
/// Edges: indeterminate where n.h is below 0, where `l` is `-v`, and at 0, as for a zero `n`, for an `s` of 0 or below; h is `l` for a zero `v`, and `v` for a zero `l`.
/// Error model: that of `blinn_phong` where n.h is above 0, none elsewhere.
float blinn_phong_hpg(vec3 n, vec3 l, vec3 v, float s) {
    return max(0.0, pow(dot(n, normalize(l + v)), s));
}

/// Blinn's lobe scaled so that its energy hardly depends on the shininess.
///
/// Parameters: `n`, `l`, `v` unit, one space, `l` and `v` away from the surface; `s` shininess, at least 0.
/// Returns: `(s + 8)/(8*pi) * blinn_phong`: a BRDF, 1/sr, at least 0.
/// Source: Akenine-Möller, Haines, Hoffman, Real-Time Rendering, 3rd edition, 2008, section 7.6.
/// Edges: as `blinn_phong`.
/// Error model: that of `blinn_phong` + 3 ULP; 0 where the lobe is below 2^-126.
float blinn_phong_normalized(vec3 n, vec3 l, vec3 v, float s) {
    // 1/(8*pi)
    return (max(s, 0.0) + 8.0) * 0.039788736 * blinn_phong(n, l, v, s);
}

/// The least alpha of highlights: the square of a perceptual roughness of 0.045.
///
/// With less, the highlight of a lamp without a size is smaller than a pixel, and at 0 it is nowhere. The programs have it (Guy, Agopian, "Physically Based Rendering in Filament", 2018, section 4.8.3.3); functions do not.
const float LEAST_ALPHA = 0.002025;

/// The GGX distribution of microfacet normals, in the form that stays accurate for small alpha.
///
/// `1 - nh^2` loses every digit near the mirror direction; the squared length of n x h does not.
///
/// Parameters: `nh` cosine n.h, [0, 1]; `n_cross_h2` squared length of n x h, [0, 1]; `alpha` squared perceptual roughness, [0, 1].
/// Returns: `(alpha/(n_cross_h2 + (nh*alpha)^2))^2/pi`, 1/sr, at least 0.
/// Source: Walter, Marschner, Li, Torrance, "Microfacet Models for Refraction through Rough Surfaces", 2007, equation 33; the form with the cross product: Filament, "Physically Based Rendering in Filament", section 4.4.1.
/// Edges: 0 for an `alpha` of 0, the mirror direction included; never above 3.2e37, which it reaches where both `nh` and `n_cross_h2` are 0, as for a zero normal. A negative `alpha` counts as its magnitude, and a denominator below 2^-126 as that.
/// Error model: 11 ULP, relative, beside twice the relative error of n_cross_h2.
float d_ggx(float nh, float n_cross_h2, float alpha) {
    float a = nh * alpha;
    // The square of a larger quotient overflows.
    float k = min(abs(alpha) / max(n_cross_h2 + a * a, SMALLEST_NORMAL), 1.0e19);
    return k * k * 0.31830989;
}

/// The height-correlated Smith visibility of GGX, divided by 4*nl*nv.
///
/// Parameters: `nv`, `nl` cosines n.v and n.l, [0, 1]; `alpha` squared perceptual roughness, [0, 1].
/// Returns: `0.5/(nl*sqrt(nv^2*(1 - a2) + a2) + nv*sqrt(nl^2*(1 - a2) + a2))` with `a2 = alpha^2`, at least 0.
/// Source: Heitz, "Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs", 2014, equation 99.
/// Edges: 0 where `nv` or `nl` is 0 or below: the light or the viewer is at or behind the horizon, and neither is seen by a facet; a negative `alpha` counts as its magnitude, one beyond 1 as 1; a denominator below 2^-126 counts as that.
/// Error model: 10 ULP, relative.
float v_smith_ggx(float nv, float nl, float alpha) {
    float a2 = clamp(alpha * alpha, 0.0, 1.0);
    float from_view = sqrt(nv * nv * (1.0 - a2) + a2);
    float from_light = sqrt(nl * nl * (1.0 - a2) + a2);
    float visibility = 0.5 / (nl * from_view + (nv * from_light + SMALLEST_NORMAL));
    return min(nv, nl) > 0.0 ? visibility : 0.0;
}

/// Schlick's approximation of Fresnel's reflectance.
///
/// Parameters: `f0` linear reflectance at normal incidence, [0, 1]; `f90` reflectance at grazing incidence, usually 1; `vh` cosine v.h, [0, 1].
/// Returns: `f0 + (f90 - f0)*(1 - vh)^5`, between `f0` and `f90`.
/// Source: Schlick, "An Inexpensive BRDF Model for Physically-Based Rendering", 1994, equation 15.
/// Edges: a `vh` outside [0, 1] is clamped to it; `f0` and `f90` are not: the result is between the two, whatever they are.
/// Error model: absolute 5*2^-23; the fifth power is three products, where `pow` allows relative 1e-6.
vec3 f_schlick(vec3 f0, float f90, float vh) {
    float x = 1.0 - clamp(vh, 0.0, 1.0);
    float x2 = x * x;
    return f0 + (vec3(f90) - f0) * (x2 * x2 * x);
}

/// `v_smith_ggx` without guards, for callers that have them: a lobe is multiplied by n.l, and leaves out what is behind.
///
/// Parameters: `nv`, `nl` cosines n.v and n.l, above 0, up to 1; `alpha` squared perceptual roughness, [0, 1].
/// Returns: as `v_smith_ggx`.
/// Source: as `v_smith_ggx`.
/// Edges: only for an `nv` and an `nl` above 1e-18 and an `alpha` in [0, 1]: elsewhere it may divide by zero, or take the root of a negative number.
/// Error model: that of `v_smith_ggx`.
float v_smith_ggx_fast(float nv, float nl, float alpha) {
    float a2 = alpha * alpha;
    float from_view = nl * sqrt(nv * nv * (1.0 - a2) + a2);
    float from_light = nv * sqrt(nl * nl * (1.0 - a2) + a2);
    return 0.5 / (from_view + from_light);
}

/// `phong` without guards, as most engines have it.
///
/// Parameters: `n`, `l`, `v` unit, one space, `l` and `v` away from the surface; `s` shininess, above 0.
/// Returns: `max(r.v, 0)^s` with `r = reflect(-l, n)`: also where the light is behind the surface, so multiply it by n.l or by a test of it.
/// Source: as `phong`.
/// Edges: 0 for a zero `v`, and for a zero `l`; r is `-l` for a zero `n`; indeterminate for an `s` of 0 or below with r.v at or below 0.
/// Error model: that of `phong`.
float phong_fast(vec3 n, vec3 l, vec3 v, float s) {
    return pow(max(dot(reflect(-l, n), v), 0.0), s);
}

/// `blinn_phong` without guards, as most engines have it.
///
/// Parameters: `n`, `l`, `v` unit, one space, `l` and `v` away from the surface; `s` shininess, above 0.
/// Returns: `max(n.h, 0)^s` with `h = normalize(l + v)`: also where the light is behind the surface, so multiply it by n.l or by a test of it.
/// Source: as `blinn_phong`.
/// Edges: 0 for a zero `n`; indeterminate where `l = -v`, and for an `s` of 0 or below with n.h at or below 0; the half vector of a zero `v` is `l`.
/// Error model: that of `blinn_phong`.
float blinn_phong_fast(vec3 n, vec3 l, vec3 v, float s) {
    return pow(max(dot(n, normalize(l + v)), 0.0), s);
}

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

#endif
