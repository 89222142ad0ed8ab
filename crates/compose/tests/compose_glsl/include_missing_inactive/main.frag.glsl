#version 450
#if FANCY
#include "fancy.glsl"
#endif
void main() {}
