//! How light weakens with distance. Each function is one factor; multiply the ones you want.
//!
//! Made from `attenuation.wesl` by `cargo xtask docs`: edit that, not this file.

#ifndef LAMPLIGHT_LIGHTING_ATTENUATION_GLSL
#define LAMPLIGHT_LIGHTING_ATTENUATION_GLSL

#include "../math/safe.glsl"

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

/// The reciprocal of a polynomial in the distance: constant, linear and quadratic attenuation.
///
/// Parameters: `d` distance to the light, scene units, at least 0; `k` constant, linear and quadratic coefficients (1, 1/unit, 1/unit^2), at least 0.
/// Returns: `1 / (k.x + k.y*d + k.z*d*d)`: in (0, 1] where `k.x` is at least 1, above 1 where the polynomial is below 1.
/// Source: Kessenich, Sellers, Shreiner, OpenGL Programming Guide, 9th edition, 2016, example 7.4.
/// Edges: 1 where the polynomial is below 2^-126, so where it is 0 or negative: a `k` of zeros means no attenuation; a negative `d` is not clamped.
/// Error model: 2.5 ULP (division) + 3 ULP (sum and products of terms of at least 0).
float polynomial(float d, vec3 k) {
    float q = k.x + d * (k.y + d * k.z);
    return q >= SMALLEST_NORMAL ? 1.0 / q : 1.0;
}

/// A straight line from 1 at the light to 0 at its radius.
///
/// Parameters: `d` distance to the light, scene units, at least 0; `radius` reach of the light, scene units.
/// Returns: `1 - clamp(d/radius, 0, 1)`, in [0, 1].
/// Source: Newcastle University, Graphics for Games, tutorial 11 "Real-Time Lighting A".
/// Edges: 0 everywhere for a `radius` of 0 or less; exactly 0 at and beyond the radius; 1 for a negative `d` otherwise.
/// Error model: absolute 2.5*2^-23*min(d/radius, 1) + 2^-24.
float linear_radius(float d, float radius) {
    float x = clamp(d / radius, 0.0, 1.0);
    return radius > 0.0 ? 1.0 - x : 0.0;
}

/// The inverse-square law, bounded near the light.
///
/// Parameters: `d2` squared distance to the light, scene units^2, at least 0; `min_d2` squared size of the light, scene units^2, above 0.
/// Returns: `1 / max(d2, min_d2)`, at least 0: above 1 within one scene unit, since it is a physical falloff and not a share.
/// Source: Lagarde, de Rousiers, "Moving Frostbite to Physically Based Rendering", 2014, section 4.5.
/// Edges: at most 2^126, where `d2` and `min_d2` are both 0 or below.
/// Error model: 2.5 ULP.
float inverse_square(float d2, float min_d2) {
    return 1.0 / max(max(d2, min_d2), SMALLEST_NORMAL);
}

/// A smooth window that brings any falloff to 0 at the range.
///
/// Parameters: `d2` squared distance to the light, scene units^2, at least 0; `inv_range2` 1/range^2, 1/scene units^2, at least 0, where 0 means no range.
/// Returns: `saturate(1 - (d/range)^4)^2`, in [0, 1], with slope 0 at the range.
/// Source: Karis, "Real Shading in Unreal Engine 4", 2013, equation 9; Lagarde, de Rousiers, 2014, section 4.5.
/// Edges: 1 where the product of `d2` and `inv_range2` is 0 or below; exactly 0 at and beyond the range.
/// Error model: absolute 2^-23 + 8*w*x*2^-23, with x = (d/range)^4 and w = 1 - x.
float window(float d2, float inv_range2) {
    float x = clamp(d2 * inv_range2, 0.0, 1.0);
    float w = 1.0 - x * x;
    return w * w;
}

/// The range factor of glTF's punctual lights, without the inverse square.
///
/// It is `window` before squaring, so its slope is not 0 at the range. Multiply it by `inverse_square`.
///
/// Parameters: `d` distance to the light, scene units, at least 0; `range` reach of the light, scene units, where 0 or less means no range.
/// Returns: `clamp(1 - (d/range)^4, 0, 1)`.
/// Source: Khronos Group, glTF extension KHR_lights_punctual, "Range Property".
/// Edges: 1 for a `range` of 0 or less, and for a negative `d`; exactly 0 at and beyond the range.
/// Error model: absolute 12*x*2^-23 + 2^-24, with x = min((d/range)^4, 1).
float range_gltf(float d, float range) {
    float x = clamp(d / range, 0.0, 1.0);
    float x2 = x * x;
    return range > 0.0 ? 1.0 - x2 * x2 : 1.0;
}

/// A power of the distance, windowed by a cutoff distance, as three.js attenuates its lights.
///
/// Parameters: `d` distance to the light, scene units, at least 0; `cutoff` reach, scene units, 0 or less means none; `decay` exponent, 2 is physical.
/// Returns: `window / max(d^decay, 0.01)`, in [0, 100].
/// Source: three.js, "getDistanceAttenuation" since revision 147, after Lagarde, de Rousiers, 2014.
/// Edges: at most 100, near the light, so for a `d` of 0 or below without a `cutoff`; exactly 0 at and beyond the cutoff, where a negative `d` counts as its magnitude; the window alone for a `decay` of 0, and a negative one brightens with the distance.
/// Error model: that of `safe_pow(d, decay)` + 4 ULP + absolute 24*x*2^-23 of the falloff, with x = min((d/cutoff)^4, 1).
float decay_cutoff(float d, float cutoff, float decay) {
    float falloff = 1.0 / max(safe_pow(d, decay), 0.01);
    float x = min(d / cutoff, 1.0);
    return falloff * (cutoff > 0.0 ? window(x * x, 1.0) : 1.0);
}

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

#endif
