#version 450
#include "light.glsl"
layout(location = 0) out vec4 color;
void main() { color = shade(); }
