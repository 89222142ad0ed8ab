#version 450
#include "shared.glsl"
layout(location = 0) in vec4 v;
layout(location = 0) out vec4 c;
void main() { c = vec4(grid(v.xy)); }
