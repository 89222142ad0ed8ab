#version 450
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;
float f(inout float x, out float y) { y = x; x += 1.0; return x * y; }
void main() { float a = uv.x, b; for (int i = 0; i < 3; i++) { float r = f(a, b) + (i > 1 ? f(b, a) : b); color[i] += r; if (r > 9.0) continue; } }
