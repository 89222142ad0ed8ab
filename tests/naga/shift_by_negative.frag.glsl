#version 450
layout(location = 0) out vec4 c;
void main() { int x = 1 << -1; c = vec4(float(x)); }
