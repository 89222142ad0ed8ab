#version 450

layout(location = 0) out vec4 lit;

float fade(float d, int rings);

float fade(int rings, float d) {
    return d / float(rings);
}

float shade(float d);

void main() {
    lit = vec4(fade(1, 2), shade(1.0), 5.0 % 2.0, 1.0);
}
