#version 450
#include "open.glsl"
#include "closed.glsl"
#include "else.glsl"
void main() {}
