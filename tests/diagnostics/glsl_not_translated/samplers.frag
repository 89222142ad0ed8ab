#version 450
layout(location = 0) in vec4 v;
layout(location = 0) out vec4 c;
layout(set = 0, binding = 0) uniform sampler2D image;
vec4 read(sampler2D from, vec2 at) { return texture(from, at); }
void main() { c = read(image, v.xy); }
