#version 450
// Ünïcödé before the errors: columns count characters, spans bytes.
#define HALF 0.5
layout(location = 0) out vec4 color;
void main() {
    /* ä */ float a = missing;
    float b = HALF * other;
    color = vec4(a, b, 0.0, 1.0);
}
