#version 450
#extension GL_GOOGLE_include_directive : require
#include <lamplight/brdf/specular.glsl>
#include <lamplight/color/transfer.glsl>

layout(location = 0) in vec3 normal;
layout(location = 1) in vec3 to_light;
layout(location = 2) in vec3 to_eye;
layout(location = 3) in vec2 uv;
layout(location = 0) out vec4 color;

layout(set = 0, binding = 0) uniform Material {
    vec3 base_color;
    float metallic;
    float roughness;
};
layout(set = 0, binding = 1) uniform texture2D base_bricks;
layout(set = 0, binding = 2) uniform sampler linear;

void main() {
    vec3 n = normalize(normal);
    vec3 l = normalize(to_light);
    vec3 v = normalize(to_eye);
    vec3 h = normalize(l + v);
    float nl = max(dot(n, l), 0.0);
    float nv = max(dot(n, v), 1e-4);
    vec3 across = cross(n, h);
    vec3 base = base_color * texture(sampler2D(base_bricks, linear), uv * vec2(3.0, 2.0)).rgb;
    float alpha = max(roughness * roughness, 0.002025);
    vec3 f = f_schlick(mix(vec3(0.04), base, metallic), 1.0, max(dot(v, h), 0.0));
    vec3 specular = d_ggx(max(dot(n, h), 0.0), dot(across, across), alpha) * v_smith_ggx(nv, nl, alpha) * f;
    vec3 diffuse = base * (1.0 - metallic) * (1.0 - f) / 3.1415927;
    color = vec4(tonemap_aces((diffuse + specular) * nl * 12.0 + base * (0.15 + 0.1 * n.y)), 1.0);
}
