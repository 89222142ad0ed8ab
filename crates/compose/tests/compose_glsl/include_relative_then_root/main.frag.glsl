#version 450
#include "a/one.glsl"
layout(location = 0) out vec4 color;
void main() { color = vec4(one() + two() + top()); }
