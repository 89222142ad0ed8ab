#version 450
#include <lib/a.glsl>
#include <own.glsl>
layout(location = 0) out vec4 color;
void main() { color = vec4(a() + own()); }
