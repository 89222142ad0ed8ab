#version 450
layout(location=0) in vec2 position;
layout(set=0,binding=0) uniform M01 { mat4 project; mat4 view; };
layout(set=2,binding=0) uniform M02 { mat4 world; };
void main() { gl_Position = project * view * world * vec4(position, 1.0, 1.0); }
