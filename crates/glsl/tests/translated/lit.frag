#version 330 core
// A surface under one lamp.

struct Material {
    sampler2D diffuse; // what is reflected
    sampler2D specular;
    float shininess;
};

in vec3 normal;
in vec2 uv;
out vec4 color;

uniform Material material;
uniform vec3 lamp;
uniform float weights[3] = float[](0.5, 0.25, 0.25);
uniform bool dim;

/* Lambert's law. */
float lambert(vec3 n) {
    return max(dot(n, lamp), 0.0);
}

void main() {
    vec3 n = normalize(normal);
    float lit = lambert(n) * weights[0];
    vec4 texel = texture(material.diffuse, uv);
    if (texel.a < 0.5) discard;
    if (dim && lit > 0.5)
        lit *= 0.5;
    color = vec4(texel.rgb * lit, 1.0);
    color.rgb += texture(material.specular, uv).rgb * pow(lit, material.shininess);
}
