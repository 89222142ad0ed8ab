//! Summed-area variance shadow maps: moments of the depth averaged over rectangles of any size, by
//! four reads of a table.
//!
//! A texel of the table has the sum of the moments of all texels from the first row and column up to
//! itself, each less the mean over the map: without it, sums in 32 bits keep too few digits of the
//! differences. The table has two components of 32-bit floats, and is read by a linear filter, which
//! gives sums up to any place within a texel. `SummedArea` of the package `lamplight-scene` makes the
//! table of a map on the host; on a GPU, two passes of prefix sums do.
//!
//! Made from `summed.wesl` by `cargo xtask docs`: edit that, not this file.

#ifndef LAMPLIGHT_SHADOW_SUMMED_GLSL
#define LAMPLIGHT_SHADOW_SUMMED_GLSL

#include "../filter/sampling.glsl"
#include "coord.glsl"
#include "moments.glsl"

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

/// The sum of the table up to a place.
///
/// Parameters: `table`, `smp` the table and a linear sampler, clamped to the edge; `corner` place in texels, [0, size].
/// Returns: the sum over the rectangle from the map's first corner, in texels.
/// Source: Crow, "Summed-Area Tables for Texture Mapping", 1984; between texels: Lauritzen, "Summed-Area Variance Shadow Maps", GPU Gems 3, 2007, chapter 8.
/// Edges: 0 before the map; beyond it, the sum at its edge.
/// Error model: the sampler's two weights, of at least 8 bits each: 2^-8 of a texel's row and column.
vec2 summed_corner(LAMPLIGHT_COLOR_MAP(table, smp), vec2 corner) {
    vec2 size = vec2(textureSize(LAMPLIGHT_COLOR_SAMPLER(table, smp), 0));
    // Before the first texels' ends nothing is stored: there the sum begins at 0.
    vec2 share = clamp(corner, vec2(0.0), vec2(1.0));
    return textureLod(LAMPLIGHT_COLOR_SAMPLER(table, smp), (max(corner, vec2(1.0)) - 0.5) / size, 0.0).xy * (share.x * share.y);
}

/// The mean moments of a square around a place in the map.
///
/// Parameters: `table`, `smp` as for `summed_corner`; `uv` texture coordinates of the middle, [0, 1]; `width` of the square, texels, at least 1; `mean` the mean moments over the map, which the sums are without.
/// Returns: the two moments, as of a filtered `vsm_moments`.
/// Source: as `summed_corner`; sums without the mean: Hensley, Scheuermann, Coombe, Singh, Lastra, "Fast Summed-Area Table Generation and its Applications", 2005.
/// Edges: what is off the map does not count; `uv` and `width` outside their ranges count as their ends; `mean` is added as it is.
/// Error model: 2^-7 of the change over a texel, over `width`; and 2^-22 of the largest of the four sums, over the square's texels.
vec2 summed_moments(LAMPLIGHT_COLOR_MAP(table, smp), vec2 uv, float width, vec2 mean) {
    vec2 size = vec2(textureSize(LAMPLIGHT_COLOR_SAMPLER(table, smp), 0));
    vec2 middle = clamp(uv, vec2(0.0), vec2(1.0)) * size;
    float half_ = 0.5 * max(width, 1.0);
    vec2 low = max(middle - half_, vec2(0.0));
    vec2 high = min(middle + half_, size);
    vec2 right = summed_corner(LAMPLIGHT_COLOR_ARG(table, smp), high) - summed_corner(LAMPLIGHT_COLOR_ARG(table, smp), vec2(high.x, low.y));
    vec2 left = summed_corner(LAMPLIGHT_COLOR_ARG(table, smp), vec2(low.x, high.y)) - summed_corner(LAMPLIGHT_COLOR_ARG(table, smp), low);
    vec2 sides = high - low;
    return (right - left) / (sides.x * sides.y) + mean;
}

/// Visibility from a summed-area variance shadow map, filtered over a square.
///
/// The width may differ from point to point, such as that of `shadow::penumbra`.
///
/// Parameters: `table`, `smp`, `width` and `mean` as for `summed_moments`; `at` place in the map; `min_variance` least variance, above 0: at least the rounding of the table; `bleed` share of the bound to cut off, [0, 1).
/// Returns: Chebyshev's bound, [0, 1].
/// Source: Lauritzen, "Summed-Area Variance Shadow Maps", GPU Gems 3, 2007, chapter 8.
/// Edges: 1 where `at` is outside; `width` and `mean` as for `summed_moments`; `min_variance` and `bleed` as for `chebyshev`.
/// Error model: that of `chebyshev` for the errors of `summed_moments`.
float savsm(LAMPLIGHT_COLOR_MAP(table, smp), ShadowUv at, float width, vec2 mean, float min_variance, float bleed) {
    if (!at.inside) {
        return 1.0;
    }
    return chebyshev(summed_moments(LAMPLIGHT_COLOR_ARG(table, smp), at.uv, width, mean), at.depth, min_variance, bleed);
}

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

#endif
