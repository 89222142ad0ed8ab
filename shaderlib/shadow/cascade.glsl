//! Which of up to four cascaded shadow maps covers a point.
//!
//! Sample distribution shadow maps (Lauritzen, Salvi, Lefohn, 2011) place the splits by the depths that
//! are seen. Finding these takes passes over the depth buffer, so the library has no such program: an
//! engine that has the least and the largest depth gives them to `cascade_split` as `near` and `far`.
//!
//! Made from `cascade.wesl` by `cargo xtask docs`: edit that, not this file.

#ifndef LAMPLIGHT_SHADOW_CASCADE_GLSL
#define LAMPLIGHT_SHADOW_CASCADE_GLSL

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

/// The index of the cascade that covers a distance.
///
/// Parameters: `view_depth` distance along the view axis, scene units; `splits` far ends of the four cascades, rising, scene units, of which the last is repeated if there are fewer.
/// Returns: 0 to 3, or 4 beyond the last cascade, where points are lit.
/// Source: Zhang, Sun, Xu, Lun, "Parallel-Split Shadow Maps for Large-Scale Virtual Environments", 2006.
/// Edges: a `view_depth` at a cascade's end belongs to the next one, a negative one to the first; where `splits` do not rise, the first that is beyond counts.
/// Error model: exact.
int cascade_index(float view_depth, vec4 splits) {
    if (view_depth < splits.x) {
        return 0;
    }
    if (view_depth < splits.y) {
        return 1;
    }
    if (view_depth < splits.z) {
        return 2;
    }
    return view_depth < splits.w ? 3 : 4;
}

/// The share of the next cascade near the end of the one that covers a distance.
///
/// There is no cascade after the last one: blend the last one with 1, which is lit.
///
/// Parameters: `view_depth` and `splits` as for `cascade_index`; `overlap` distance before a cascade's end over which the next one fades in, scene units.
/// Returns: 0 to 1, rising over the overlap.
/// Source: Microsoft, "Cascaded Shadow Maps", DirectX technical article: blending between cascades.
/// Edges: 0 for an `overlap` of 0 or less, and for a `view_depth` beyond all `splits`.
/// Error model: absolute 2^-22 + 2^-23*(view_depth + split)/overlap.
float cascade_blend(float view_depth, vec4 splits, float overlap) {
    int index = cascade_index(view_depth, splits);
    if (index > 3 || !(overlap > 0.0)) {
        return 0.0;
    }
    return clamp((view_depth - splits[index] + overlap) / overlap, 0.0, 1.0);
}

/// The far end of one cascade, between logarithmic and even splits.
///
/// Parameters: `index` of the split, 0 for `near`, `count` for `far`; `count` number of cascades, at least 1; `near`, `far` range, scene units, `0 < near < far`; `lambda` share of the logarithmic splits, [0, 1].
/// Returns: `lambda*near*(far/near)^(index/count) + (1 - lambda)*(near + (far - near)*index/count)`, scene units.
/// Source: Zhang, Sun, Xu, Lun, "Parallel-Split Shadow Maps for Large-Scale Virtual Environments", 2006, equation 5.
/// Edges: `near` for a `far` that is not beyond it, and for a `count` of 0; `near` counts as at least 1e-6; an `index` beyond `count` counts as that, `lambda` is clamped; indeterminate where `far` or `far/near` is above 1e38, so for a plane at the largest number.
/// Error model: relative 2^-21 + 2^-22*log2(far/near).
float cascade_split(uint index, uint count, float near, float far, float lambda) {
    float first = max(near, 1e-6);
    float last = max(far, first);
    float share = float(min(index, count)) / float(max(count, 1u));
    float even = first + (last - first) * share;
    float logarithmic = first * exp2(share * log2(last / first));
    float weight = clamp(lambda, 0.0, 1.0);
    return logarithmic * weight + even * (1.0 - weight);
}

/// What moves a shadow map to whole texels, so that its edges stand still while the camera moves.
///
/// Parameters: `origin` the world's origin, or any fixed point, in the map's normalised device coordinates; `size` texels across the map, at least 1. The map's own size in the scene must not change from frame to frame.
/// Returns: an offset for the map's projection, in normalised device coordinates, at most one texel: `(round(o) - o)*2/size` with `o = origin*size/2`.
/// Source: Valient, "Stable Rendering of Cascaded Shadow Maps", ShaderX 6, 2008; Pettineo, "A Sampling of Shadow Techniques", 2013.
/// Edges: a `size` below 1 counts as 1; zero for a zero `origin`.
/// Error model: absolute 2^-23*|origin|; a point half way between texels goes to either.
vec2 cascade_snap(vec2 origin, float size) {
    float scale = 0.5 * max(size, 1.0);
    vec2 texel = origin * scale;
    return (floor(texel + 0.5) - texel) / scale;
}

/// The smallest sphere around a slice of a view frustum: a map of its size fits however the camera turns.
///
/// Parameters: `near`, `far` ends of the slice, scene units, `0 <= near <= far`; `tangents` tangents of half the angles of view, across and up, at least 0.
/// Returns: x the distance of the centre from the eye along the view axis, y the radius, scene units.
/// Source: Valient, "Stable Rendering of Cascaded Shadow Maps", ShaderX 6, 2008; Zhang, Zaprjagaev, Bentham, "Practical Cascaded Shadow Maps", ShaderX 7, 2009.
/// Edges: a wide slice's centre is at its far end, not beyond it, and so is that of a `near` beyond `far`; zero for a `far` of 0 or below; `tangents` count as their magnitudes: for zeros, half the depth of the slice is the radius.
/// Error model: 2^-21 of the centre, 2^-21*(far + radius) of the radius.
vec2 bounding_sphere(float near, float far, vec2 tangents) {
    float k2 = dot(tangents, tangents);
    float end = max(far, 0.0);
    float centre = clamp(0.5 * (near + end) * (1.0 + k2), 0.0, end);
    float behind = end - centre;
    return vec2(centre, sqrt(behind * behind + end * end * k2));
}

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

#endif
