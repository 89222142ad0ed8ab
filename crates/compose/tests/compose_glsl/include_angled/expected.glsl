#version 450

float b() { return 1.0; }

float a() { return b(); }

float own() { return 2.0; }

layout(location = 0) out vec4 color;

void main() { color = vec4(a() + own()); }
// ---- Fragment; reads: 
