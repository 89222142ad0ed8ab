#version 330 core
// OpenGL 3.3 with a vertex stage of its own, in the other file. Colours are as the display shows them.
in vec3 v_normal;
in vec3 v_position;
uniform vec3 lightPos;
uniform vec3 viewPos;
uniform vec3 objectColor;
out vec4 FragColor;

void main() {
    vec3 n = normalize(v_normal);
    vec3 l = normalize(lightPos - v_position);
    vec3 h = normalize(l + normalize(viewPos - v_position));
    float light = 0.15 + max(dot(n, l), 0.0);
    FragColor = vec4(objectColor * light + 0.5 * pow(max(dot(n, h), 0.0), 64.0), 1.0);
}
