#version 450
layout(location = 0) in vec4 p;
float twice(float x);
vec4 place(in vec4 v);
void main() { gl_Position = place(p) * twice(2.0); }
vec4 place(in vec4 v) { return v + vec4(twice(v.x)); }
float twice(float x) { return x * 2.0; }
