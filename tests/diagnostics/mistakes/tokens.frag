#version 450
layout(location = 0) out vec4 colour;
void main() {
    float x = 1.0
}
