#version 450

layout(location = 0) out vec4 color;

const int A = 100;

const int B = 7 + 5;

const int D = 2;

const int C = 9;

void main() { color = vec4(A, B, C, D); }
// ---- Fragment; reads: 
// `100` from main.frag.glsl:4:15 `__LINE__`
// `7 + 5` from main.frag.glsl:7:15 `__LINE__`
// `+ 5` from main.frag.glsl:7:24 `+ __FILE__`
