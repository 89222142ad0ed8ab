#version 450
#include <n/k.glsl>
layout(location = 0) out vec4 color;
void main() { color = vec4(k()); }
