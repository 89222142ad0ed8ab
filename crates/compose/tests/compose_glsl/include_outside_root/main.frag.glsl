#version 450
#include "../secret.glsl"
#include "a/b.glsl"
#include </etc/passwd>
#include "/etc/passwd"
void main() {}
