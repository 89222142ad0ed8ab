#version 450

// Two functions.
float half_of(float x) { return x * 0.5; }

float twice(float x) { return x * 2.0; }

// A texture.
layout(set = 0, binding = 0) uniform texture2D map;

layout(set = 0, binding = 1) uniform sampler smp;

// Luma.
float luma(float x) { return dot(vec3(x), vec3(0.2, 0.7, 0.1)); }

layout(location = 0) out vec4 color;

void main() {
    color = texture(sampler2D(map, smp), vec2(half_of(1.0), twice(luma(1.0))));
}
// ---- Fragment; reads: 
// `float luma` from main.frag.glsl:11:1 `UNARY(luma,
    dot(vec3(x), vec3(0.2, 0.7, 0.1)))`
