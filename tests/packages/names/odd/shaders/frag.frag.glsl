#version 450
#include <a-b/k.glsl>
#include <z/k.glsl>
layout(location = 0) out vec4 color;
void main() { color = vec4(k()); }
