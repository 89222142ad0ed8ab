//! The separable Gaussian blur of variance shadow maps.
//!
//! Made from `gaussian.wesl` by `cargo xtask docs`: edit that, not this file.

#ifndef LAMPLIGHT_FILTER_GAUSSIAN_GLSL
#define LAMPLIGHT_FILTER_GAUSSIAN_GLSL

#include "sampling.glsl"

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

/// The weight of a tap of the 21-tap kernel.
///
/// Parameters: `i` number of the tap, from -10 to 10.
/// Returns: `exp(-i^2/16)` over the sum of all 21: a variance of 8 texels^2, 0.14107424 in the middle.
/// Source: Movania et al., OpenGL: Build High Performance Graphics, 2017, chapter 4, variance shadow mapping, which prints the numbers.
/// Edges: 0 beyond 10 on either side.
/// Error model: (4 + i^2/8) ULP.
float gaussian21(int i) {
    float x = float(i);
    return abs(i) <= 10 ? 0.14107424 * exp(-x * x / 16.0) : 0.0;
}

/// One pass of the 21-tap blur along a direction.
///
/// Blur once across and once down. Build a map's mips after the blur, not before it as the recipe does.
///
/// Parameters: `map`, `smp` texture and sampler, read at its first mip; `uv` texture coordinates; `direction` step between taps, texels: (1, 0) or (0, 1).
/// Returns: the weighted sum of 21 reads; the weights' sum is 1.
/// Source: Movania et al., OpenGL: Build High Performance Graphics, 2017, chapter 4, variance shadow mapping.
/// Edges: a `uv` beyond the edge follows the sampler: clamp it to the edge; a zero `direction` leaves the map as it is there.
/// Error model: absolute 2^-19 of the largest read; the sampler's own weights where uv is not at a texel's centre.
vec4 blur21(LAMPLIGHT_COLOR_MAP(map, smp), vec2 uv, vec2 direction) {
    vec2 stride = direction / vec2(textureSize(LAMPLIGHT_COLOR_SAMPLER(map, smp), 0));
    vec4 sum = vec4(0.0);
    for (int i = -10; i <= 10; i++) {
        sum += gaussian21(i) * textureLod(LAMPLIGHT_COLOR_SAMPLER(map, smp), uv + float(i) * stride, 0.0);
    }
    return sum;
}

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

#endif
