#version 450
layout(location = 0) in vec3 world;
layout(location = 1) in vec3 normal;
layout(location = 0) out vec4 color;
layout(set = 0, binding = 0, std140) uniform Camera { mat4 view_projection; vec3 eye; float near; } camera;
layout(set = 0, binding = 1, std140) uniform Light { vec4 position; vec3 tint; float shininess; };
layout(set = 1, binding = 0) uniform texture2D albedo;
layout(set = 1, binding = 1) uniform sampler smooth_sampler;
layout(set = 1, binding = 2) uniform texture2D shadow_map;
layout(set = 1, binding = 3) uniform samplerShadow shadow_sampler;
vec4 texel(texture2D map, sampler samp, vec2 uv) { return texture(sampler2D(map, samp), uv); }
float visibility(texture2D map, samplerShadow samp, vec3 at) { return textureLod(sampler2DShadow(map, samp), at, 0.0); }
void main() {
    vec3 n = normalize(normal);
    vec3 l = normalize(position.xyz - world);
    vec3 h = normalize(l + normalize(camera.eye - world));
    float specular = pow(max(dot(n, h), 0.0), shininess);
    color = texel(albedo, smooth_sampler, world.xy) * visibility(shadow_map, shadow_sampler, world) + vec4(tint * specular, 1.0);
}
