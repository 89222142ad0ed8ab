#version 450

float two() { return 2.0; }

float top() { return 3.0; }

float one() { return 1.0; }

layout(location = 0) out vec4 color;

void main() { color = vec4(one() + two() + top()); }
// ---- Fragment; reads: 
