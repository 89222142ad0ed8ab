//! Visibility from filtered moments of the depth: variance shadow maps, plain and exponential.

#ifndef LAMPLIGHT_SHADOW_MOMENTS_GLSL
#define LAMPLIGHT_SHADOW_MOMENTS_GLSL

#include "../math/safe.glsl"

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

/// The two moments of a depth.
///
/// Parameters: `d` depth, [0, 1] from near to far, bias added.
/// Returns: `(d, d^2)`, to be stored and filtered.
/// Source: Donnelly, Lauritzen, "Variance Shadow Maps", 2006; Movania et al., OpenGL: Build High Performance Graphics, 2017, chapter 4, variance shadow mapping.
/// Edges: none.
/// Error model: 1 ULP.
vec2 vsm_moments(float d) {
    return vec2(d, d * d);
}

/// The two moments of a depth that slopes within its texel.
///
/// Parameters: `d` depth, [0, 1] from near to far; `dx`, `dy` its change per texel: the screen-space derivatives of the depth pass.
/// Returns: `(d, d^2 + 0.25*(dx^2 + dy^2))`, to be stored and filtered.
/// Source: Lauritzen, "Summed-Area Variance Shadow Maps", GPU Gems 3, 2007, chapter 8.
/// Edges: none; a steep edge may need its derivatives bounded.
/// Error model: 3 ULP; the derivatives themselves have no bound.
vec2 vsm_moments_slope(float d, float dx, float dy) {
    return vec2(d, d * d + 0.25 * (dx * dx + dy * dy));
}

/// Chebyshev's bound on the share of depths at or beyond a depth.
///
/// Parameters: `m` first and second moment; `t` the depth; `min_variance` least variance, above 0, against rounding; `bleed` share of the bound to cut off, [0, 1).
/// Returns: 1 where `t <= m.x`, else `saturate((p - bleed)/(1 - bleed))` with `p = var/(var + (t - m.x)^2)`: in [0, 1].
/// Source: Donnelly, Lauritzen, "Variance Shadow Maps", 2006; the cut against light bleeding: Lauritzen, GPU Gems 3, 2007, chapter 8.
/// Edges: 0 beyond the mean for a bleed of 1 or more; a variance of 0 counts as 2^-126.
/// Error model: absolute p*(1 - p)*(rel(var) + 2*rel(t - m.x)) + 4*2^-23, over 1 - bleed, where rel(var) is 2^-22*m.y/var and rel(t - m.x) is 2^-23*t/(t - m.x).
float chebyshev(vec2 m, float t, float min_variance, float bleed) {
    if (t <= m.x) {
        return 1.0;
    }
    float variance = max(max(m.y - m.x * m.x, min_variance), SMALLEST_NORMAL);
    float beyond = t - m.x;
    float p = variance / (variance + beyond * beyond);
    return clamp((p - bleed) / max(1.0 - bleed, SMALLEST_NORMAL), 0.0, 1.0);
}

/// Visibility from the filtered moments of a variance shadow map.
///
/// Parameters: `m` filtered `vsm_moments`; `t` the point's depth, [0, 1]; `min_variance` least variance, 0.00002 in the recipe; `least` least visibility, [0, 1], 0.2 in the recipe; `bleed` share of the bound to cut off, [0, 1), 0 in the recipe.
/// Returns: visibility, [least, 1].
/// Source: Movania et al., OpenGL: Build High Performance Graphics, 2017, chapter 4, variance shadow mapping.
/// Edges: 1 where `t <= m.x`, and `least` only beyond: a full shadow is not darker.
/// Error model: that of `chebyshev`.
float vsm_visibility(vec2 m, float t, float min_variance, float least, float bleed) {
    return max(chebyshev(m, t, min_variance, bleed), least);
}

/// A depth bent by two exponentials, one for each sign.
///
/// Parameters: `d` depth, [0, 1] from near to far; `exponents` positive and negative, above 0: up to 42 for moments of 32 bits, 5.5 for 16.
/// Returns: `(exp(x*z), -exp(-y*z))` with `z = 2*d - 1`: both rise with the depth.
/// Source: Lauritzen, McCool, "Layered Variance Shadow Maps", 2008, section 5: exponential variance shadow maps.
/// Edges: beyond the exponents above, the second moments overflow.
/// Error model: relative (3.5 + 3*e)*2^-23, with e the exponent.
vec2 evsm_warp(float d, vec2 exponents) {
    float z = 2.0 * d - 1.0;
    return vec2(exp(exponents.x * z), -exp(-exponents.y * z));
}

/// The four moments of a bent depth.
///
/// Parameters: `d` and `exponents` as for `evsm_warp`.
/// Returns: `(p, p^2, q, q^2)` for `(p, q) = evsm_warp(d, exponents)`, to be stored and filtered.
/// Source: as `evsm_warp`.
/// Edges: as `evsm_warp`.
/// Error model: twice that of `evsm_warp` + 0.5 ULP.
vec4 evsm_moments(float d, vec2 exponents) {
    vec2 w = evsm_warp(d, exponents);
    return vec4(w.x, w.x * w.x, w.y, w.y * w.y);
}

/// Visibility from the filtered moments of an exponential variance shadow map.
///
/// Parameters: `m4` filtered `evsm_moments`; `t` the point's depth, [0, 1]; `exponents` those the moments were made with; `min_variance` least variance, in depth squared; `bleed` share of the bounds to cut off, [0, 1).
/// Returns: the smaller of the two bounds, visibility, [0, 1].
/// Source: Lauritzen, McCool, "Layered Variance Shadow Maps", 2008, section 5; the least variance is scaled by the slope of the warp at `t`.
/// Edges: as `chebyshev`.
/// Error model: that of `chebyshev`, with the relative errors of `evsm_moments` for those of the moments; 2^-18 for mixtures of two depths and exponents up to 40.
float evsm_visibility(vec4 m4, float t, vec2 exponents, float min_variance, float bleed) {
    vec2 w = evsm_warp(t, exponents);
    vec2 slope = 2.0 * exponents * w;
    float positive = chebyshev(m4.xy, w.x, min_variance * slope.x * slope.x, bleed);
    float negative = chebyshev(m4.zw, w.y, min_variance * slope.y * slope.y, bleed);
    return min(positive, negative);
}

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

#endif
