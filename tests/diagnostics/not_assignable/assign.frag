#version 450
layout(set = 0, binding = 0) uniform U { float x; } u;
layout(location = 0) out vec4 color;
void main() { u.x = 1.0; color = vec4(u.x); }
