#version 330 core
in vec2 uv;
in float shade;
in vec3 normal;
layout(location = 0) out vec4 colour;

uniform sampler2D albedo;

UNIFORMS

vec3 lit(vec3 n, vec3 l) {
    return lamp.colour * max(dot(n, l), 0.0);
}

void main() {
    vec4 texel = texture(albedo, uv);
    if (texel.a < 0.25 && is_cut) {
        discard;
    }
    vec3 sum = vec3(0.0);
    for (int i = 0; i < 2; i++) {
        sum += tints[i] * texel.rgb * shade;
    }
    colour = vec4(sum + lit(normalize(normal), lamp.direction) * scale, 1.0);
}
