#version 450
//! The vertex stage of `depth_view`, which `depth_view.wesl` describes.
//!
//! Made from `depth_view.wesl` by `cargo xtask docs`: edit that, not this file.

layout(location = 0) out vec2 out_uv;

void main() {
    vec2 uv = vec2(float(uint(gl_VertexIndex) & 1u), float(uint(gl_VertexIndex) >> 1u)) * 2.0;
    gl_Position = vec4(2.0 * uv.x - 1.0, 1.0 - 2.0 * uv.y, 0.0, 1.0);
    out_uv = uv;
}
