#version 450
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 0) out vec3 world;
layout(location = 1) out vec3 world_normal;
layout(set = 0, binding = 0, std140) uniform Camera { mat4 view_projection; mat4 model; } camera;
void main() {
    vec4 at = camera.model * vec4(position, 1.0);
    world = at.xyz;
    world_normal = mat3(camera.model) * normal;
    gl_Position = camera.view_projection * at;
}
