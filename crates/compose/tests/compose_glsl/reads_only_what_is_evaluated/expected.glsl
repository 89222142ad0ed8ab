#version 450

const int N = 3;

layout(location = 0) out vec4 color;

void main() { color = vec4(float(N)); }
// ---- Fragment; reads: a=true size=3
// `3` from main.frag.glsl:3:15 `SIZE`
