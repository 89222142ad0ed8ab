#version 450
#include "a/x.glsl"
#include "./a/../a/./x.glsl"
#include <a/x.glsl>
void main() { x(); }
