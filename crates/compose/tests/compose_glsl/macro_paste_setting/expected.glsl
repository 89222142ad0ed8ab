#version 450

float shade_1() { return 1.0; }

layout(location = 0) out vec4 color;

void main() { color = vec4(shade_1()); }
// ---- Fragment; reads: shadow=hard
