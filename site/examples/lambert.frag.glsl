#version 450
#extension GL_GOOGLE_include_directive : require
#include <lamplight/brdf/diffuse.glsl>
#include <lamplight/brdf/specular.glsl>

layout(location = 0) in vec3 normal;
layout(location = 1) in vec3 to_light;
layout(location = 2) in vec3 to_eye;
layout(location = 0) out vec4 color;

layout(set = 0, binding = 0) uniform Material {
    vec3 base_color;
    float shininess;
};

void main() {
    vec3 n = normalize(normal);
    vec3 l = normalize(to_light);
    float light = lambert(n, l) + 0.05;
    color = vec4(base_color * light + blinn_phong(n, l, normalize(to_eye), shininess), 1.0);
}
