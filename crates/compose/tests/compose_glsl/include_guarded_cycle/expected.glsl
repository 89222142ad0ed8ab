#version 450

float b() { return 1.0; }

float a() { return b(); }

layout(location = 0) out vec4 color;

void main() { color = vec4(a()); }
// ---- Fragment; reads: 
