#version 450
#define PI 3.14159
#define TAU (2.0 * PI)
#define EMPTY
#define STATEMENT a = a * 2.0; \
    a += PI;
layout(location = 0) out vec4 color;
void main() {
    float a = PI;
    float b = TAU EMPTY;
    STATEMENT
    color = vec4(a, b, -PI, 1.0-PI);
}
