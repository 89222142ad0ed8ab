//! The direction to the viewer, in eye space.

#ifndef LAMPLIGHT_SURFACE_VIEW_GLSL
#define LAMPLIGHT_SURFACE_VIEW_GLSL

#include "../math/safe.glsl"

/// The direction to a viewer at the eye.
vec3 view_local(vec3 p_eye) {
    return safe_normalize(-p_eye, vec3(0.0, 0.0, 1.0));
}

/// The direction to a viewer infinitely far away.
vec3 view_infinite() {
    return vec3(0.0, 0.0, 1.0);
}

#endif
