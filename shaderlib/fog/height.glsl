//! Fog that thins with height, in closed form along a straight view.
//!
//! Made from `height.wesl` by `cargo xtask docs`: edit that, not this file.

#ifndef LAMPLIGHT_FOG_HEIGHT_GLSL
#define LAMPLIGHT_FOG_HEIGHT_GLSL

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

/// The optical depth of fog whose density falls exponentially with height.
///
/// The view's transmittance is `exp(-depth)`. Upwards, the depth of a long view nears `density*exp(-falloff*(y0 - base))/(falloff*dy)`, so a sky dome may be as far as the frame likes.
///
/// Parameters: `y0` height of the eye, scene units; `base` height at which the fog has its density, scene units; `dy` the unit view direction's component upwards, [-1, 1]; `dist` length of the view, scene units, at least 0; `density` at the base, 1/scene units, at least 0; `falloff` of the density with height, 1/scene units, at least 0.
/// Returns: `density*exp(-falloff*(y0 - base))*(1 - exp(-x))/x*dist` with `x = falloff*dy*dist`, at least 0.
/// Source: Wenzel, "Real-time Atmospheric Effects in Games", SIGGRAPH 2006; Quilez, "Better Fog", 2010. The larger exponential, that of the view's lower end, is put before the brackets, so the rest is a mean of [0, 1].
/// Edges: constant fog for a `falloff` of 0; `density*dist` at a level view at the base; a negative `dist`, `density` or `falloff` counts as 0, and each counts as at most 1e6; never above 1e20, which is opaque; where fog is more than `exp(60)` times as dense as at the base, it is that dense; `y0`, `base` and `dy` are not clamped.
/// Error model: relative 2^-20 + 2^-22*falloff*(|y0 - base| + |dy*dist|).
float fog_height(float y0, float dy, float dist, float density, float falloff, float base) {
    float fall = clamp(falloff, 0.0, 1e6);
    float far = clamp(dist, 0.0, 1e6);
    float rise = dy * far;
    float most = exp(min(fall * (base - y0 - min(rise, 0.0)), 60.0));
    float whole = clamp(density, 0.0, 1e6) * far * most;
    float x = fall * abs(rise);
    // (1 - exp(-x))/x loses its digits near 0, where its series has few terms.
    if (x < 0.1) {
        return min(whole * (1.0 - x * (0.5 - x * (0.16666667 - x * 0.041666668))), 1e20);
    }
    return min(whole * ((1.0 - exp(-x)) / x), 1e20);
}

/// What fog of an optical depth leaves of the light.
///
/// Parameters: `depth` optical depth, at least 0.
/// Returns: `exp(-depth)`, [0, 1]: 1 is clear, 0 all fog.
/// Source: Beer's law; Wenzel, "Real-time Atmospheric Effects in Games", SIGGRAPH 2006.
/// Edges: 1 for a negative depth.
/// Error model: relative (3 + 2*depth)*2^-23.
float fog_transmittance(float depth) {
    return exp(-max(depth, 0.0));
}

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

#endif
