#version 330 core
in vec3 position;
in vec3 normal;
uniform mat4 model;
uniform mat4 view;
uniform mat4 projection;
uniform float time;
out vec3 v_normal;
out vec3 v_position;

void main() {
    float angle = sin(time) * position.y;
    mat3 turn = mat3(cos(angle), 0.0, -sin(angle), 0.0, 1.0, 0.0, sin(angle), 0.0, cos(angle));
    vec4 world = model * vec4(turn * position, 1.0);
    v_position = world.xyz;
    v_normal = mat3(model) * (turn * normal);
    gl_Position = projection * view * world;
}
