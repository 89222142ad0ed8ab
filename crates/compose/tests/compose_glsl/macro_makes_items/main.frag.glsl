#version 450
#define UNARY(name, expression) float name(float x) { return expression; }
#define BINDING(n, kind, name) layout(set = 0, binding = n) uniform kind name;
// Two functions.
UNARY(half_of, x * 0.5) UNARY(twice, x * 2.0)
UNARY(unused, x)
// A texture.
BINDING(0, texture2D, map) BINDING(1, sampler, smp)
BINDING(2, texture2D, unused_map)
// Luma.
UNARY(luma,
    dot(vec3(x), vec3(0.2, 0.7, 0.1)))
layout(location = 0) out vec4 color;
void main() {
    color = texture(sampler2D(map, smp), vec2(half_of(1.0), twice(luma(1.0))));
}
