//! Where the viewer of `forward` is.

#ifndef LAMPLIGHT_PROGRAMS_FORWARD_VIEWER_GLSL
#define LAMPLIGHT_PROGRAMS_FORWARD_VIEWER_GLSL

#include "camera.glsl"

/// Whether anything depends on the direction of the viewer.
#define NEEDS_VIEW (SPECULAR != SPECULAR_NONE || DIFFUSE == DIFFUSE_OREN_NAYAR || AMBIENT == AMBIENT_IBL)

#if NEEDS_VIEW
#include "../../surface/view.glsl"

/// Unit direction from a point to the viewer.
vec3 towards_viewer(vec3 position) {
#if VIEWER == VIEWER_LOCAL
    return view_local(position - camera.world_from_view[3].xyz);
#else
    return (camera.world_from_view * vec4(view_infinite(), 0.0)).xyz;
#endif
}
#endif

#endif
