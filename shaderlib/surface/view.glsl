//! The direction to the viewer, in eye space.
//!
//! Made from `view.wesl` by `cargo xtask docs`: edit that, not this file.

#ifndef LAMPLIGHT_SURFACE_VIEW_GLSL
#define LAMPLIGHT_SURFACE_VIEW_GLSL

#include "../math/safe.glsl"

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

/// The direction to a viewer at the eye.
///
/// Parameters: `p_eye` the lit point, eye space, scene units.
/// Returns: unit vector from the point to the eye, eye space.
/// Source: Kessenich, Sellers, Shreiner, OpenGL Programming Guide, 9th edition, 2016, chapter 7, "Lighting Coordinate Systems": the local viewer.
/// Edges: (0, 0, 1) for a point at the eye.
/// Error model: that of `safe_normalize`.
vec3 view_local(vec3 p_eye) {
    return safe_normalize(-p_eye, vec3(0.0, 0.0, 1.0));
}

/// The direction to a viewer infinitely far away.
///
/// Parameters: none.
/// Returns: (0, 0, 1), eye space: towards the viewer, where the book's prose says -z.
/// Source: Kessenich, Sellers, Shreiner, OpenGL Programming Guide, 9th edition, 2016, chapter 7, "Lighting Coordinate Systems", example 7.4.
/// Edges: none.
/// Error model: exact.
vec3 view_infinite() {
    return vec3(0.0, 0.0, 1.0);
}

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

#endif
