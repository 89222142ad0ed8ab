//! The width of a penumbra, the soft edge of a shadow.
//!
//! Made from `penumbra.wesl` by `cargo xtask docs`: edit that, not this file.

#ifndef LAMPLIGHT_SHADOW_PENUMBRA_GLSL
#define LAMPLIGHT_SHADOW_PENUMBRA_GLSL

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

/// The width of the penumbra of an area light at a finite distance.
///
/// Parameters: `receiver`, `blocker` linear distances from the light to the lit point and to what shadows it, scene units, above 0; `size` of the light, scene units, at least 0.
/// Returns: `(receiver - blocker)*size/blocker`, scene units at the lit point.
/// Source: Fernando, "Percentage-Closer Soft Shadows", 2005: similar triangles; with linear distances, which a depth buffer does not hold.
/// Edges: 0 where `blocker` is not before `receiver`, and where there is none: a `blocker` of 0 or less; a negative `size` counts as 0; never more than 1e6 times the size.
/// Error model: 3 ULP, and 2^-23*receiver*size/blocker.
float pcss_width(float receiver, float blocker, float size) {
    float between = max(min(receiver - blocker, 1e6 * blocker), 0.0);
    return max(size, 0.0) * (between / max(blocker, 1e-30));
}

/// The width of the penumbra of a distant light.
///
/// Parameters: `receiver`, `blocker` linear distances along the light's direction, scene units; `size` diameter of the light over its distance, at least 0: 0.0093 for the sun.
/// Returns: `(receiver - blocker)*size`, scene units.
/// Source: Fernando, "Percentage-Closer Soft Shadows", 2005, for a light at infinity.
/// Edges: 0 where `blocker` is not before `receiver`, and for a `size` of 0 or below; distances may have any sign.
/// Error model: 2 ULP, and 2^-23*(|receiver| + |blocker|)*size.
float pcss_width_directional(float receiver, float blocker, float size) {
    return max(receiver - blocker, 0.0) * max(size, 0.0);
}

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

#endif
