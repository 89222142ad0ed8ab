#version 450
//! The vertex stage of `moments`, which `moments.wesl` describes.
//!
//! Made from `moments.wesl` by `cargo xtask docs`: edit that, not this file.

layout(location = 0) in vec3 in_position;

/// The light in the place of the viewer; the first member of the camera of `forward`.
layout(std140, set = 0, binding = 0) uniform Camera {
    mat4 clip_from_world;
} camera;

/// The first member of the object of `forward`.
layout(std140, set = 2, binding = 0) uniform Object {
    mat4 world_from_object;
} object;

void main() {
    gl_Position = camera.clip_from_world * (object.world_from_object * vec4(in_position, 1.0));
}
