#version 330 core
layout(location = 0) in vec3 place;
layout(location = 1) in vec3 facing;
layout(location = 2) in vec2 wrapped;

out vec3 normal;
out vec2 uv;
out float shade;

UNIFORMS

float falloff[2];

void main() {
    vec4 seen = projection * view * vec4(place, 1.0);
    falloff[1] = place.y * tints[1].x;
    shade = 0.25 + 0.5 * falloff[1] * falloff[1] + scale;
    uv = wrapped;
    normal = mat3(view) * facing;
    gl_Position = seen;
}
