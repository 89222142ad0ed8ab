#version 450
//! The fragment stage of `depth_view`, which `depth_view.wesl` describes.
//!
//! Made from `depth_view.wesl` by `cargo xtask docs`: edit that, not this file.

#if CURVE == CURVE_LINEAR || CURVE == CURVE_IGL
#include "../shadow/coord.glsl"
#endif

layout(location = 0) in vec2 in_uv;

layout(location = 0) out vec4 out_color;

layout(set = 0, binding = 0) uniform texture2D depths;
layout(set = 0, binding = 1) uniform sampler depth_sampler;

#if CURVE == CURVE_LINEAR
/// Distances of the planes of the projection that the depths were drawn with, in scene units. Swap them for reversed depth.
layout(std140, set = 0, binding = 2) uniform Planes {
    float near;
    float far;
} planes;
#endif

void main() {
    float depth = textureLod(sampler2D(depths, depth_sampler), in_uv, 0.0).x;
#if CURVE == CURVE_LINEAR
    float shade = linearize_depth(depth, planes.near, planes.far) / max(planes.near, planes.far);
#elif CURVE == CURVE_IGL
    float shade = depth_view_igl(depth);
#else
    float shade = depth;
#endif
    out_color = vec4(vec3(shade), 1.0);
}
