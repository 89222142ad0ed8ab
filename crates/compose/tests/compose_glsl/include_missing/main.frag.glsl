#version 450
#include "shadwo.glsl"
#include <lib/missing.glsl>
#include <lib/sub/light.gls>
#if 0
#include "never.glsl"
#endif
void main() {}
