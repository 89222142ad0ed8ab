#version 460 core
layout(rgba8, binding = 0) writeonly uniform image2D img;
void main() { imageStore(img, ivec2(0), vec4(0)); int i = 0; imageStore(img, ivec2(i), vec4(1)); }
