#version 450
//! The fragment stage of `blur`, which `blur.wesl` describes.
//!
//! Made from `blur.wesl` by `cargo xtask docs`: edit that, not this file.

#include "../filter/gaussian.glsl"

layout(location = 0) in vec2 in_uv;

layout(location = 0) out vec4 out_color;

layout(set = 0, binding = 0) uniform texture2D blurred;
layout(set = 0, binding = 1) uniform sampler linear_sampler;

void main() {
#if DIRECTION == DIRECTION_DOWN
    vec2 direction = vec2(0.0, 1.0);
#else
    vec2 direction = vec2(1.0, 0.0);
#endif
    out_color = blur21(blurred, linear_sampler, in_uv, direction);
}
