#version 450
#include "refused.glsl"
layout(location = 0) out vec4 c;
void main() { c = vec4(disc(gl_PointCoord)); }
