#version 450
//! The vertex stage of `gbuffer`, which `gbuffer.wesl` describes.
//!
//! Made from `gbuffer.wesl` by `cargo xtask docs`: edit that, not this file.

#if NORMAL_MAP
#include "../surface/normal.glsl"
#endif

layout(location = 0) in vec3 in_position;
layout(location = 1) in vec3 in_normal;
layout(location = 2) in vec4 in_color;
#if BASE_MAP || NORMAL_MAP || METALLIC_ROUGHNESS_MAP
layout(location = 3) in vec2 in_uv;
#endif
#if NORMAL_MAP
layout(location = 5) in vec4 in_tangent;
#endif
layout(location = 6) in uint in_material;

layout(location = 1) out vec3 out_normal;
layout(location = 2) out vec4 out_color;
#if BASE_MAP || NORMAL_MAP || METALLIC_ROUGHNESS_MAP
layout(location = 3) out vec2 out_uv;
#endif
#if NORMAL_MAP
layout(location = 5) out vec4 out_tangent;
#endif
layout(location = 6) flat out uint out_material;

/// The viewer.
layout(std140, set = 0, binding = 0) uniform Camera {
    mat4 clip_from_world;
} camera;

/// What is drawn.
layout(std140, set = 2, binding = 0) uniform Object {
    /// It may mirror. Then fronts are clockwise, which the engine tells the rasteriser.
    mat4 world_from_object;
    /// The inverse transpose of the former, for normals.
    mat4 normal_from_object;
    /// Multiplied with the vertex colours.
    vec4 color;
} object;

void main() {
    gl_Position = camera.clip_from_world * (object.world_from_object * vec4(in_position, 1.0));
    out_normal = (object.normal_from_object * vec4(in_normal, 0.0)).xyz;
    out_color = in_color * object.color;
#if BASE_MAP || NORMAL_MAP || METALLIC_ROUGHNESS_MAP
    out_uv = in_uv;
#endif
#if NORMAL_MAP
    out_tangent = world_tangent(in_tangent, object.world_from_object);
#endif
    out_material = in_material;
}
