//! Visibility from filtered moments of the depth: variance shadow maps, plain and exponential.

#ifndef LAMPLIGHT_SHADOW_MOMENTS_GLSL
#define LAMPLIGHT_SHADOW_MOMENTS_GLSL

#include "../math/safe.glsl"

/// The two moments of a depth.
vec2 vsm_moments(float d) {
    return vec2(d, d * d);
}

/// The two moments of a depth that slopes within its texel.
vec2 vsm_moments_slope(float d, float dx, float dy) {
    return vec2(d, d * d + 0.25 * (dx * dx + dy * dy));
}

/// Chebyshev's bound on the share of depths at or beyond a depth.
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
float vsm_visibility(vec2 m, float t, float min_variance, float least, float bleed) {
    return max(chebyshev(m, t, min_variance, bleed), least);
}

/// A depth bent by two exponentials, one for each sign.
vec2 evsm_warp(float d, vec2 exponents) {
    float z = 2.0 * d - 1.0;
    return vec2(exp(exponents.x * z), -exp(-exponents.y * z));
}

/// The four moments of a bent depth.
vec4 evsm_moments(float d, vec2 exponents) {
    vec2 w = evsm_warp(d, exponents);
    return vec4(w.x, w.x * w.x, w.y, w.y * w.y);
}

/// Visibility from the filtered moments of an exponential variance shadow map.
float evsm_visibility(vec4 m4, float t, vec2 exponents, float min_variance, float bleed) {
    vec2 w = evsm_warp(t, exponents);
    vec2 slope = 2.0 * exponents * w;
    float positive = chebyshev(m4.xy, w.x, min_variance * slope.x * slope.x, bleed);
    float negative = chebyshev(m4.zw, w.y, min_variance * slope.y * slope.y, bleed);
    return min(positive, negative);
}

#endif
