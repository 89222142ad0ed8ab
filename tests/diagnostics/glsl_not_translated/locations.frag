#version 450
in vec2 uv;
layout(location = 0) out vec4 c;
in Carried { vec3 normal; } carried;
void main() { c = vec4(uv, carried.normal.xy); }
