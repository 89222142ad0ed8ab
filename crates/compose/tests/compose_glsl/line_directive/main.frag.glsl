#version 450
layout(location = 0) out vec4 color;
#line 100
const int A = __LINE__;
#define N 7
#line N 5
const int B = __LINE__ + __FILE__;
#include "a.glsl"
const int C = __LINE__;
void main() { color = vec4(A, B, C, D); }
