#version 450
#include <lamplight/lighting/attenuation.glsl>
layout(location = 0) out vec4 colour;
void main() { colour = vec4(inverse_square(1.0, vec2(1.0))); }
