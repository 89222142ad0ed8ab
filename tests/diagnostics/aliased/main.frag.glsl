#version 450
layout(location = 0) out vec4 color;

void add(inout float to, inout float other) { to += other; }

void main() {
    float v = 1.0;
    add(v, v);
    color = vec4(v);
}
