//! Sheen: the light rim of cloth, from fibres that stand on the surface.
//!
//! Every `alpha` is squared perceptual roughness, also where a source passes the roughness itself.
//!
//! Made from `sheen.wesl` by `cargo xtask docs`: edit that, not this file.

#ifndef LAMPLIGHT_BRDF_SHEEN_GLSL
#define LAMPLIGHT_BRDF_SHEEN_GLSL

#include "../math/safe.glsl"

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

/// The Charlie distribution of the normals of fibres.
///
/// Parameters: `nh` cosine n.h, [0, 1]; `alpha` squared perceptual roughness, [0, 1].
/// Returns: `(2 + 1/alpha)*s^(1/alpha)/(2*pi)` with s the sine, 1/sr, at least 0.
/// Source: Estevez, Kulla, "Production Friendly Microfacet Sheen BRDF", 2017; Khronos Group, KHR_materials_sheen, 2020.
/// Edges: 0 along the normal; an `nh` outside [0, 1] is clamped to it; an `alpha` below 0.001 counts as 0.001, one above 1 is not clamped.
/// Error model: relative that of `pow((1 - nh)*(1 + nh), 0.5/alpha)` + 10*2^-23.
float d_charlie(float nh, float alpha) {
    float c = clamp(nh, 0.0, 1.0);
    float e = 1.0 / max(alpha, 0.001);
    return (2.0 + e) * cosine_power((1.0 - c) * (1.0 + c), 0.5 * e) * 0.15915494;
}

/// A visibility of fibres that needs no roughness.
///
/// It does not conserve energy: with the Charlie distribution, up to 1.7 times the light from grazing directions is reflected. Scale the material below by `sheen_scale`.
///
/// Parameters: `nl`, `nv` cosines n.l and n.v, [0, 1].
/// Returns: `1/(4*(nl + nv - nl*nv))`, at least 0.
/// Source: Neubelt, Pettineo, "Crafting a Next-Gen Material Pipeline for The Order: 1886", 2013.
/// Edges: 0 where `nl` or `nv` is 0 or below: the light or the viewer is at or behind the horizon; a sum below 1e-6 counts as 1e-6.
/// Error model: 6 ULP.
float v_neubelt(float nl, float nv) {
    if (!(nl > 0.0 && nv > 0.0)) {
        return 0.0;
    }
    return 0.25 / max(nl + nv - nl * nv, 1e-6);
}

/// The exponent of Charlie's Lambda for cosines up to 1/2.
///
/// Parameters: `x` cosine, (0, 0.5]; `w` weight of the coefficients for roughness 0, `(1 - alpha)^2`.
/// Returns: `a/(1 + b*x^c) + d*x + e`.
/// Source: as `v_charlie`.
/// Edges: indeterminate for an `x` of 0 or below; `w` is not clamped.
/// Error model: absolute 64*2^-23.
float charlie_exponent(float x, float w) {
    float a = 21.5473 + 3.7772 * w;
    float b = 3.82987 - 0.50552 * w;
    float c = 0.19823 - 0.03022 * w;
    float d = -1.9776 + 0.70367 * w;
    float e = -4.32054 - 0.53913 * w;
    return a / (1.0 + b * pow(x, c)) + d * x + e;
}

/// Charlie's Lambda: how much the fibres hide of a direction.
///
/// Parameters: `mu` cosine to the normal, (0, 1]; `alpha` squared perceptual roughness, [0, 1].
/// Returns: at least 0, about 1e9 for the horizon.
/// Source: as `v_charlie`.
/// Edges: a `mu` outside [1e-6, 1 - 1e-6] is clamped to it, an `alpha` outside [0, 1] too.
/// Error model: relative 100*2^-23.
float charlie_lambda(float mu, float alpha) {
    float x = clamp(mu, 1e-6, 0.999999);
    float y = 1.0 - clamp(alpha, 0.0, 1.0);
    float w = y * y;
    if (x < 0.5) {
        return exp(charlie_exponent(x, w));
    }
    return exp(2.0 * charlie_exponent(0.5, w) - charlie_exponent(1.0 - x, w));
}

/// The visibility of the Charlie distribution, with the shadows that fibres throw on each other.
///
/// Parameters: `nl`, `nv` cosines n.l and n.v, [0, 1]; `alpha` squared perceptual roughness, [0, 1].
/// Returns: `1/((1 + L(nv) + L(nl))*4*nl*nv)`, L being Charlie's Lambda, at least 0.
/// Source: Estevez, Kulla, "Production Friendly Microfacet Sheen BRDF", 2017; Khronos Group, KHR_materials_sheen, 2020.
/// Edges: 0 where `nl` or `nv` is 0 or below: the light or the viewer is at or behind the horizon; a product `nl*nv` below 1e-12 counts as 1e-12; an `alpha` outside [0, 1] is clamped to it.
/// Error model: relative 110*2^-23.
float v_charlie(float nl, float nv, float alpha) {
    if (!(nl > 0.0 && nv > 0.0)) {
        return 0.0;
    }
    float hidden = 1.0 + charlie_lambda(nv, alpha) + charlie_lambda(nl, alpha);
    return 0.25 / (hidden * max(nl * nv, 1e-12));
}

/// The share of light that the Charlie distribution with `v_neubelt` reflects into all directions.
///
/// Parameters: `nv` cosine n.v, [0, 1]; `alpha` squared perceptual roughness, [0, 1].
/// Returns: directional albedo of a white sheen, [0, 1].
/// Source: Academy Software Foundation, MaterialX shader library, 2020: a rational fit. What it calls roughness is `alpha` here.
/// Edges: parameters outside [0, 1] are clamped to it.
/// Error model: relative 2^-18; the fit is within 0.04 of the integral for alpha from 0.3 on, within 0.08 for alpha from 0.1 on.
float sheen_albedo(float nv, float alpha) {
    float x = clamp(nv, 0.0, 1.0);
    float y = clamp(alpha, 0.0, 1.0);
    float over = 13.673 + x * (-68.78018 + 60.28956 * x) + y * (799.08825 - 905.00061 * x + 1086.96473 * y);
    float under = 1.0 + x * (61.57746 + 121.81241 * x) + y * (442.78211 + 2597.49308 * x + 3045.55075 * y);
    return clamp(over / under, 0.0, 1.0);
}

/// What a sheen leaves of the light for the material below it.
///
/// Parameters: `color` linear colour of the sheen, [0, 1]; `ev`, `el` albedo of a white sheen towards the viewer and the light, [0, 1].
/// Returns: `min(1 - m*ev, 1 - m*el)` with m the largest channel, [0, 1].
/// Source: Khronos Group, KHR_materials_sheen, 2020: albedo scaling.
/// Edges: 1 for a black `color`, and where `ev` and `el` are 0; the result is clamped to [0, 1], its parameters are not.
/// Error model: absolute 2^-23.
float sheen_scale(vec3 color, float ev, float el) {
    float largest = max(max(color.x, color.y), color.z);
    return clamp(1.0 - largest * max(ev, el), 0.0, 1.0);
}

/// A sheen as a linearly transformed cosine, fitted to a layer of fibres.
///
/// Parameters: `nv` cosine n.v, [0, 1]; `roughness` perceptual, [0, 1].
/// Returns: `(a, b, R)`: two entries of the inverse matrix for `sheen_ltc_lobe`, and the share of light that the sheen reflects, [0, 1]. What is left for the material below is `1 - R`.
/// Source: Zeltner, Burley, Chiang, "Practical Multiple-Scattering Sheen Using Linearly Transformed Cosines", 2022, in the fit of Academy Software Foundation, MaterialX, 2023.
/// Edges: an `nv` outside [0, 1] and a `roughness` outside [0.01, 1] are clamped to it.
/// Error model: relative 2^-18.
vec3 sheen_ltc(float nv, float roughness) {
    float x = clamp(nv, 0.0, 1.0);
    float y = clamp(roughness, 0.01, 1.0);
    float a = y * (2.58126 * x + 0.813703 * y) / (1.0 + 0.310327 * x * x + 2.60994 * x * y);
    float b_under = 0.0000254053 + 1.71228 * x - 1.71506 * x * y + 1.34174 * y * y;
    float b = sqrt(1.0 - x) * (y - 1.0) * y * y * y / b_under;
    float width = y * (0.0206607 + 1.58491 * y) / (0.0379424 + y * (1.32227 + y));
    float middle = y * (-0.193854 + y * (-1.14885 + y * (1.7932 - 0.95943 * y * y))) / (0.046391 + y);
    float offset = y * (0.000654023 + y * (-0.0207818 + 0.119681 * y)) / (1.26264 + y * (-1.92021 + y));
    float d = (x - middle) / width;
    float share = exp(-0.5 * d * d) / width * 0.39894228 + offset;
    return vec3(a, b, clamp(share, 0.0, 1.0));
}

/// The lobe of a sheen that `sheen_ltc` describes.
///
/// Parameters: `t` the result of `sheen_ltc`; `w` unit direction of the light in the frame whose z is the normal and whose x is the viewer's direction along the surface.
/// Returns: the lobe with its cosine, 1/sr, at least 0: its integral over all directions is 1. Multiply it by `t.z` and the sheen's colour.
/// Source: Zeltner, Burley, Chiang, "Practical Multiple-Scattering Sheen Using Linearly Transformed Cosines", 2022, equation 6.
/// Edges: 0 where the transformed direction is at or below the horizon, and where `t` or `w` is zero; a length below 1e-9 counts as that.
/// Error model: relative 24*2^-23 of the value without its cosine.
float sheen_ltc_lobe(vec3 t, vec3 w) {
    vec3 wo = vec3(t.x * w.x + t.y * w.z, t.x * w.y, w.z);
    float size2 = max(dot(wo, wo), 1e-18);
    return max(wo.z, 0.0) * 0.31830989 * (t.x / size2) * (t.x / size2);
}

/// `v_neubelt` without guards.
///
/// Parameters: `nl`, `nv` cosines n.l and n.v, at least 0, not both 0, up to 1.
/// Returns: as `v_neubelt`.
/// Source: as `v_neubelt`.
/// Edges: only for an `nl` and an `nv` in [0, 1], of which one is above 0: elsewhere it may be negative, or divide by zero.
/// Error model: that of `v_neubelt`.
float v_neubelt_fast(float nl, float nv) {
    return 0.25 / (nl + nv - nl * nv);
}

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

#endif
