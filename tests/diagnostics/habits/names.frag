#version 450
in vec3 n;
layout(location=0) out vec4 o;
float gl_helper(float x) { return x; }
void main() { float nromal = 1.0; o = vec4(normal, colour, lerp(1.0, 2.0, 0.5), 1.0); }
