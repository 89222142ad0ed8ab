//! Weights of the light probes around a point in an irradiance field (DDGI), from the distances that the probes see.
//!
//! Made from `ddgi.wesl` by `cargo xtask docs`: edit that, not this file.

#ifndef LAMPLIGHT_AMBIENT_DDGI_GLSL
#define LAMPLIGHT_AMBIENT_DDGI_GLSL

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

/// The share of a probe's light that reaches a distance, from the mean distances that the probe sees.
///
/// Parameters: `mean`, `mean2` mean of the distance and of its square towards the point, scene units and scene units^2; `dist` distance of the point from the probe, scene units; `least` value that is left where all is hidden, [0, 1].
/// Returns: Chebyshev's bound cubed, [least, 1]; 1 up to the mean.
/// Source: Majercik, Guertin, Nowrouzezahrai, McGuire, "Dynamic Diffuse Global Illumination with Ray-Traced Irradiance Fields", 2019, section 5.2.
/// Edges: `least` where `dist` is beyond a `mean` without variance; a `mean2` below the square of `mean` counts as if it were as far above it; a `least` outside [0, 1] counts as the nearer bound; negative distances are compared as they are.
/// Error model: relative 2^-20 + 2^-21*mean^2/variance.
float ddgi_chebyshev(float mean, float mean2, float dist, float least) {
    if (!(dist > mean)) {
        return 1.0;
    }
    float variance = abs(mean * mean - mean2);
    float beyond = dist - mean;
    float bound = variance / max(variance + beyond * beyond, 1e-30);
    return max(bound * bound * bound, min(least, 1.0));
}

/// A probe's weight from its visibility, with small weights made smaller.
///
/// Parameters: `n` unit normal of the surface; `dir` unit, from the point to the probe; `tri` the probe's trilinear share, [0, 1]; `visibility` as from `ddgi_chebyshev`, [0, 1].
/// Returns: the weight, above 0: a weight w below 0.2 counts as w^3/0.04, so that the curve has no jump.
/// Source: Majercik, Guertin, Nowrouzezahrai, McGuire, "Dynamic Diffuse Global Illumination with Ray-Traced Irradiance Fields", 2019, section 5.2 and its listing.
/// Edges: `tri` counts as at least 0.001, and a weight from a `visibility` of 0 or below as 1e-6; the cosine of `n` and `dir` is clamped to [-1, 1], so zero vectors count as at a right angle.
/// Error model: relative 2^-20.
float ddgi_crushed(vec3 n, vec3 dir, float tri, float visibility) {
    float wrapped = 0.5 * clamp(dot(n, dir), -1.0, 1.0) + 0.5;
    float weight = max((wrapped * wrapped + 0.2) * visibility, 1e-6);
    float crushed = weight < 0.2 ? weight * weight * weight * 25.0 : weight;
    return crushed * max(tri, 0.001);
}

/// The weight of one of the eight probes around a point, not normalised: divide by the sum of the eight weights.
///
/// Parameters: `n` unit normal of the surface; `dir` unit, from the point to the probe, the same space; `tri` the probe's trilinear share, [0, 1]; `mean`, `mean2` mean of the distance and of its square that the probe sees towards the point, scene units and scene units^2; `dist` distance of the point from the probe, scene units.
/// Returns: the weight, above 0.
/// Source: Majercik, Guertin, Nowrouzezahrai, McGuire, "Dynamic Diffuse Global Illumination with Ray-Traced Irradiance Fields", 2019, section 5.2 and its listing: a wrapped cosine, visibility, and small weights crushed.
/// Edges: never 0, so that the sum of eight is not: a `tri` below 0.001 counts as that; a zero `n` or `dir` counts as at a right angle; `mean`, `mean2` and `dist` as for `ddgi_chebyshev`.
/// Error model: relative 2^-19 + 2^-19*mean^2/variance.
float ddgi_weight(vec3 n, vec3 dir, float tri, float mean, float mean2, float dist) {
    return ddgi_crushed(n, dir, tri, ddgi_chebyshev(mean, mean2, dist, 0.0));
}

/// `ddgi_weight` with a visibility of at least 0.05, even where the probe does not see the point.
///
/// Parameters: `n` unit normal of the surface; `dir` unit, from the point to the probe; `tri` trilinear share, [0, 1]; `mean`, `mean2` mean of the distance and of its square, scene units and scene units^2; `dist` distance of the point, scene units.
/// Returns: the weight, above 0.
/// Source: NVIDIA, RTXGI SDK 1.3, 2022, `DDGIGetVolumeIrradiance`: a floor of 0.05 for the cubed bound.
/// Edges: as for `ddgi_weight`.
/// Error model: that of `ddgi_weight`.
float ddgi_weight_rtxgi(vec3 n, vec3 dir, float tri, float mean, float mean2, float dist) {
    return ddgi_crushed(n, dir, tri, ddgi_chebyshev(mean, mean2, dist, 0.05));
}

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

#endif
