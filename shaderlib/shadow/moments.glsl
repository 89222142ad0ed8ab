//! Visibility from filtered moments of the depth: variance shadow maps, plain and exponential, and
//! moment shadow maps.
//!
//! `shadow::summed` filters the moments over rectangles of any size, and `shadow::layered` has moments
//! of their own for each interval of depths, against light bleeding.
//!
//! Made from `moments.wesl` by `cargo xtask docs`: edit that, not this file.

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
/// Edges: `d` is not clamped.
/// Error model: 1 ULP.
vec2 vsm_moments(float d) {
    return vec2(d, d * d);
}

/// The two moments of a depth that slopes within its texel.
///
/// Parameters: `d` depth, [0, 1] from near to far; `dx`, `dy` its change per texel: the screen-space derivatives of the depth pass.
/// Returns: `(d, d^2 + 0.25*(dx^2 + dy^2))`, to be stored and filtered.
/// Source: Lauritzen, "Summed-Area Variance Shadow Maps", GPU Gems 3, 2007, chapter 8.
/// Edges: `d`, `dx` and `dy` are not clamped: a steep edge may need its derivatives bounded.
/// Error model: 3 ULP; the derivatives themselves have no bound.
vec2 vsm_moments_slope(float d, float dx, float dy) {
    return vec2(d, d * d + 0.25 * (dx * dx + dy * dy));
}

/// Chebyshev's bound on the share of depths at or beyond a depth.
///
/// Parameters: `m` first and second moment; `t` the depth; `min_variance` least variance, above 0, against rounding; `bleed` share of the bound to cut off, [0, 1).
/// Returns: 1 where `t <= m.x`, else `saturate((p - bleed)/(1 - bleed))` with `p = var/(var + (t - m.x)^2)`: in [0, 1].
/// Source: Donnelly, Lauritzen, "Variance Shadow Maps", 2006; the cut against light bleeding: Lauritzen, GPU Gems 3, 2007, chapter 8.
/// Edges: 1 for every `t` up to the mean of `m`, negative ones too; 0 beyond the mean for a `bleed` of 1 or more, and a negative one brightens; a variance below `min_variance`, negative ones too, counts as that, and as at least 2^-126.
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
/// Edges: 1 where `t <= m.x`, and `least` only beyond: a full shadow is not darker; `least` is not clamped; `m`, `t`, `min_variance` and `bleed` as for `chebyshev`.
/// Error model: that of `chebyshev`.
float vsm_visibility(vec2 m, float t, float min_variance, float least, float bleed) {
    return max(chebyshev(m, t, min_variance, bleed), least);
}

/// A depth warped by a positive and by a negative exponential.
///
/// Parameters: `d` depth, [0, 1] from near to far; `exponents` positive and negative, above 0: up to 42 for moments of 32 bits, 5.5 for 16.
/// Returns: `(exp(x*z), -exp(-y*z))` with `z = 2*d - 1`: both rise with the depth.
/// Source: Lauritzen, McCool, "Layered Variance Shadow Maps", 2008, section 5: exponential variance shadow maps.
/// Edges: `exponents` count as at most 42 over the depth, so that second moments do not overflow; (1, -1) for zeros; `d` is not clamped.
/// Error model: relative (3.5 + 3*e)*2^-23, with e the exponent.
vec2 evsm_warp(float d, vec2 exponents) {
    float z = 2.0 * d - 1.0;
    return vec2(exp(min(exponents.x * z, 42.0)), -exp(min(-exponents.y * z, 42.0)));
}

/// The four moments of a warped depth: two for each exponential.
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
/// Edges: as `chebyshev`, with depths and exponents as for `evsm_warp`.
/// Error model: that of `chebyshev`, with the relative errors of `evsm_moments` for those of the moments; 2^-18 for mixtures of two depths and exponents up to 40.
float evsm_visibility(vec4 m4, float t, vec2 exponents, float min_variance, float bleed) {
    vec2 w = evsm_warp(t, exponents);
    // Deviations are scaled, not variances: the square of the slope alone may overflow, and
    // compilers may regroup factors.
    vec2 least = 2.0 * sqrt(max(min_variance, 0.0)) * exponents * w;
    float positive = chebyshev(m4.xy, w.x, least.x * least.x, bleed);
    float negative = chebyshev(m4.zw, w.y, least.y * least.y, bleed);
    return min(positive, negative);
}

/// The exponential of a depth: what an exponential shadow map stores, and is filtered.
///
/// Parameters: `d` depth, [0, 1] from near to far; `c` sharpness, [0, 80].
/// Returns: `exp(c*d)`, [1, 5.6e34].
/// Source: Annen, Mertens, Seidel, Flerackers, Kautz, "Exponential Shadow Maps", 2008, section 3.
/// Edges: parameters outside their ranges are clamped, so that the result is finite.
/// Error model: relative (3 + 2*x)*2^-23, with x = c*d.
float esm_moment(float d, float c) {
    return exp(clamp(c, 0.0, 80.0) * clamp(d, 0.0, 1.0));
}

/// Visibility from a filtered exponential shadow map.
///
/// Parameters: `m` filtered `esm_moment`, at least 0; `t` depth of the lit point, [0, 1]; `c` sharpness as for `m`, [0, 80].
/// Returns: `m*exp(-c*t)`, clamped to [0, 1].
/// Source: Annen, Mertens, Seidel, Flerackers, Kautz, "Exponential Shadow Maps", 2008, equation 4.
/// Edges: parameters outside their ranges are clamped; where a part of the filter is behind the point it is too bright.
/// Error model: relative (4 + 2*x)*2^-23, with x = c*t.
float esm_visibility(float m, float t, float c) {
    return clamp(m * exp(-(clamp(c, 0.0, 80.0) * clamp(t, 0.0, 1.0))), 0.0, 1.0);
}

/// The four moments of a depth.
///
/// Parameters: `d` depth, [0, 1] from near to far.
/// Returns: `(d, d^2, d^3, d^4)`.
/// Source: Peters, Klein, "Moment Shadow Mapping", 2015, section 3.
/// Edges: `d` is not clamped.
/// Error model: 1.5 ULP.
vec4 msm_moments(float d) {
    float d2 = d * d;
    return vec4(d, d2, d * d2, d2 * d2);
}

/// Four moments transformed so that 16 bits for each keep as much precision as possible.
///
/// The transform is affine, so moments can be filtered before or after it.
///
/// Parameters: `m` moments of depths in [0, 1].
/// Returns: the quantised form, in [0, 1] up to rounding.
/// Source: Peters, Klein, "Moment Shadow Mapping", 2015, section 3.5 and its listing: a row vector times the matrix.
/// Edges: `m` is not clamped; (0.035955884801, 0, 0, 0) for zeros.
/// Error model: absolute 2^-23 times the sum of the terms' magnitudes, at most 2e-5.
vec4 msm_quantise(vec4 m) {
    vec4 turned = m.x * vec4(-2.07224649, 13.7948857237, 0.105877704, 9.7924062118) + m.y * vec4(32.23703778, -59.4683975703, -1.9077466311, -33.7652110555)
        + m.z * vec4(-68.571074599, 82.0359750338, 9.3496555107, 47.9456096605) + m.w * vec4(39.3703274134, -35.364903257, -6.6543490743, -23.9728048165);
    return turned + vec4(0.035955884801, 0.0, 0.0, 0.0);
}

/// Four moments from their quantised form.
///
/// Parameters: `q` as from `msm_quantise`, after storing and filtering.
/// Returns: the moments.
/// Source: Peters, Klein, "Moment Shadow Mapping", 2015, section 3.5 and its listing.
/// Edges: `q` is not clamped; zeros for (0.035955884801, 0, 0, 0).
/// Error model: absolute 4*2^-23 times the sum of the terms' magnitudes.
vec4 msm_dequantise(vec4 q) {
    return (q.x - 0.035955884801) * vec4(0.2227744146, 0.1549679261, 0.1451988946, 0.163127443)
        + q.y * vec4(0.0771972861, 0.1394629426, 0.2120202157, 0.2591432266)
        + q.z * vec4(0.7926986636, 0.7963415838, 0.7258694464, 0.6539092497)
        + q.w * vec4(0.0319417555, -0.1722823173, -0.2758014811, -0.3376131734);
}

/// Visibility from four filtered moments: the largest that depths of these moments allow.
///
/// There is one distribution of three depths, of which one is the lit point's, that has these moments. Its share nearer than the lit point is the shadow.
///
/// Parameters: `m` filtered moments of depths in [0, 1]; `t` depth of the lit point; `bias` weight, [0, 1], of the moments (0.5, 0.5, 0.5, 0.5) that are mixed in against rounding: 3e-5 for moments in 32 bits, 6e-5 for 16.
/// Returns: visibility, [0, 1].
/// Source: Peters, Klein, "Moment Shadow Mapping", 2015, algorithm 3, by Cholesky's factors of the Hankel matrix.
/// Edges: where the moments `m` are of a single depth, 1 for a `t` up to it and 0 beyond; for moments that no depths have, as a `bias` outside [0, 1] may make them, some number in [0, 1].
/// Error model: absolute 2^-22/D, with D the determinant of the Hankel matrix of the mixed moments; the bias alone makes it 1e-8.
float msm_visibility(vec4 m, float t, float bias) {
    vec4 b = mix(m, vec4(0.5), bias);
    float variance = b.y - b.x * b.x;
    if (!(variance > 1e-12)) {
        return t <= b.x ? 1.0 : 0.0;
    }
    float skew = b.z - b.x * b.y;
    float slope = skew / variance;
    // The last pivot; rounding takes it below zero where two depths explain the moments.
    float last = max(b.w - b.y * b.y - skew * slope, 1e-12);
    float c1 = t - b.x;
    float c2 = (t * t - b.y - slope * c1) / last;
    // The polynomial c2*x^2 + k1*x + k0 whose roots are the other two depths.
    float k1 = c1 / variance - slope * c2;
    float k0 = 1.0 - k1 * b.x - c2 * b.y;
    // By the sum of what has one sign: roots far apart keep their digits.
    float root = sqrt(max(k1 * k1 - 4.0 * c2 * k0, 0.0));
    float sum = -0.5 * (k1 + (k1 >= 0.0 ? root : -root));
    float one = sum / (abs(c2) < 1e-12 ? 1e-12 : c2);
    float two = k0 / (abs(sum) < 1e-12 ? 1e-12 : sum);
    float low = min(one, two);
    float high = max(one, two);
    if (t <= low) {
        return 1.0;
    }
    // Before the point is the lower depth, or both: all that is not beyond the point or at it.
    bool beyond = high >= t;
    float first = beyond ? t : low;
    float other = beyond ? low : t;
    float below = (high - other) * (t - low);
    float share = (first * high - b.x * (first + high) + b.y) / (abs(below) < 1e-30 ? 1e-30 : below);
    return clamp(1.0 - (beyond ? share : 1.0 + share), 0.0, 1.0);
}

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

#endif
