#version 450
#include "a.glsl"
float f() { return 1.0; }
void main() {}
