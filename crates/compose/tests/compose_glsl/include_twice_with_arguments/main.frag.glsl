#version 450
#define NAME f
#define TYPE float
#include "twice.glsl"
#undef TYPE
#define TYPE vec3
#include "twice.glsl"
layout(location = 0) out vec4 color;
void main() { color = vec4(f(vec3(1.0)), f(1.0)); }
