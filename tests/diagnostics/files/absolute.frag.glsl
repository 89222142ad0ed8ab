#version 450
#include "/secret.glsl"
void main() {}
