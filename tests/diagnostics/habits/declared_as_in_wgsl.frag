#version 450
layout(location=0) in vec3 n;
layout(location=0) out vec4 o;
void main() { let c: vec3f = n; o = vec4(c, 1.0); }
