//! The camera of `forward`.

#ifndef LAMPLIGHT_PROGRAMS_FORWARD_CAMERA_GLSL
#define LAMPLIGHT_PROGRAMS_FORWARD_CAMERA_GLSL

/// The viewer.
layout(std140, set = 0, binding = 0) uniform Camera {
    mat4 clip_from_world;
    /// Its third column points behind the viewer, its fourth is the viewer's position.
    mat4 world_from_view;
} camera;

#endif
