#version 450
#define CAT(a, b) a##b
#define XCAT(a, b) CAT(a, b)
float shade_0() { return 0.0; }
float shade_1() { return 1.0; }
layout(location = 0) out vec4 color;
void main() { color = vec4(XCAT(shade_, SHADOW)()); }
