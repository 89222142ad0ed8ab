#version 330 core
in vec3 view_position;
uniform float density;
uniform vec3 fog;
out vec4 color;

float clear(float way) {
    return exp(-density * way);
}

void main() {
    float way = 0.0;
    for (int i = 0; i < 3; i++) {
        float part = length(view_position) * float(i);
        way += part;
    }
    float share = clear(way);
    color = vec4(mix(fog, vec3(0.9, 0.4, 0.1), share), 1.0);
}
