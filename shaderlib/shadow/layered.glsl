//! Layered variance shadow maps: two moments for each of up to four intervals of depths, so that what
//! is in one interval does not bleed into another.
//!
//! Choose three bounds between the layers. In the depth pass, store `lvsm_moments` of each layer, two
//! layers in a texture of four components, and filter them as other moments. A lit point takes the
//! layer of `lvsm_layer`, and reads its moments alone.
//!
//! Made from `layered.wesl` by `cargo xtask docs`: edit that, not this file.

#ifndef LAMPLIGHT_SHADOW_LAYERED_GLSL
#define LAMPLIGHT_SHADOW_LAYERED_GLSL

#include "moments.glsl"

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

/// The least width of an interval of depths.
const float LEAST_WIDTH = 1e-6;

/// The layer that a depth is in.
///
/// Parameters: `t` the point's depth, [0, 1]; `bounds` depths between the layers, rising, of which those above 1 end fewer layers.
/// Returns: 0 to 3.
/// Source: Lauritzen, McCool, "Layered Variance Shadow Maps", 2008.
/// Edges: 0 for a `t` before all of them and 3 for one behind; a bound belongs to the layer behind it; `bounds` that do not rise are counted all the same.
/// Error model: exact.
uint lvsm_layer(float t, vec3 bounds) {
    return (t >= bounds.x ? 1u : 0u) + (t >= bounds.y ? 1u : 0u) + (t >= bounds.z ? 1u : 0u);
}

/// The interval of depths whose moments a layer has.
///
/// A point at the front of an interval that does not overlap the one before it is at the depth of all that is before it, and lit.
///
/// Parameters: `layer` 0 to 3; `bounds` as for `lvsm_layer`; `overlap` how far the interval reaches beyond its bounds, [0, 1]: some times the root of the least variance, such as 0.02.
/// Returns: near and far depth, each in [0, 1].
/// Source: as `lvsm_layer`.
/// Edges: a `layer` above 3 counts as 3; the first interval begins at 0, the last one ends at 1; `bounds` outside of [0, 1] count as its ends, which a large `overlap` reaches; a negative one leaves gaps between the intervals.
/// Error model: absolute 2^-23.
vec2 lvsm_range(uint layer, vec3 bounds, float overlap) {
    uint index = min(layer, 3u);
    vec4 near = vec4(0.0, bounds - overlap);
    vec4 far = vec4(bounds + overlap, 1.0);
    return clamp(vec2(near[index], far[index]), vec2(0.0), vec2(1.0));
}

/// A depth as a share of an interval: 0 before it, 1 behind it.
///
/// Parameters: `d` depth, [0, 1]; `range` near and far depth of the interval, as of `lvsm_range`.
/// Returns: [0, 1], rising over the interval.
/// Source: as `lvsm_layer`: the warp of a layer.
/// Edges: a `d` outside of the interval gives 0 or 1; a `range` narrower than 1e-6 counts as that wide.
/// Error model: absolute 3*2^-23 + 2^-23/(range.y - range.x).
float lvsm_warp(float d, vec2 range) {
    return clamp((d - range.x) / max(range.y - range.x, LEAST_WIDTH), 0.0, 1.0);
}

/// The two moments of a depth in a layer.
///
/// Parameters: `d` depth, [0, 1] from near to far, bias added; `range` as for `lvsm_warp`.
/// Returns: `(w, w^2)` for `w = lvsm_warp(d, range)`, each in [0, 1], to be stored and filtered: 16 bits are enough where 32 are needed for the whole range.
/// Source: as `lvsm_layer`.
/// Edges: as `lvsm_warp`.
/// Error model: twice that of `lvsm_warp` + 1 ULP.
vec2 lvsm_moments(float d, vec2 range) {
    float w = lvsm_warp(d, range);
    return vec2(w, w * w);
}

/// Visibility from the filtered moments of a layer.
///
/// Parameters: `m` filtered `lvsm_moments`; `t` the point's depth, [0, 1]; `range` that of the point's layer, with which the moments were made; `min_variance` least variance, in depth squared; `bleed` share of the bound to cut off, [0, 1).
/// Returns: Chebyshev's bound in the layer, [0, 1].
/// Source: as `lvsm_layer`; the least variance is scaled by the slope of the warp.
/// Edges: 1 for a `t` at the near end of the interval or before it; a narrow `range` as for `lvsm_warp`; `m`, `min_variance` and `bleed` as for `chebyshev`.
/// Error model: that of `chebyshev`, for the warped depth.
float lvsm_visibility(vec2 m, float t, vec2 range, float min_variance, float bleed) {
    float width = max(range.y - range.x, LEAST_WIDTH);
    return chebyshev(m, lvsm_warp(t, range), min_variance / (width * width), bleed);
}

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

#endif
