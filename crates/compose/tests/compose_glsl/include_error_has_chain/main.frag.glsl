#version 450

#include "a.glsl"
void main() {}
