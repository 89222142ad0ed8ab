#version 450
//! One triangle over the whole target, without vertex buffers: the vertex stage of the full-screen programs.

layout(location = 0) out vec2 out_uv;

void main() {
    vec2 uv = vec2(float(gl_VertexIndex & 1), float(gl_VertexIndex >> 1)) * 2.0;
    out_uv = uv;
    gl_Position = vec4(2.0 * uv.x - 1.0, 1.0 - 2.0 * uv.y, 0.0, 1.0);
}
