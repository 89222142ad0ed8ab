#version 450
#extension GL_GOOGLE_include_directive : require
#include <lamplight/brdf/diffuse.glsl>

layout(location = 0) in vec3 normal;
layout(location = 1) in vec3 to_light;
layout(location = 2) in vec3 to_eye;
layout(location = 0) out vec4 color;

layout(set = 0, binding = 0) uniform Toon {
    vec3 base_color;
    float bands;
};

void main() {
    vec3 n = normalize(normal);
    float light = floor(lambert(n, normalize(to_light)) * bands + 0.5) / bands;
    float outline = step(0.25, dot(n, normalize(to_eye)));
    color = vec4(base_color * (light + 0.1) * outline, 1.0);
}
