#version 450
#include <x/f.glsl>
layout(location = 0) out vec4 color;
void main() { color = vec4(f()); }
