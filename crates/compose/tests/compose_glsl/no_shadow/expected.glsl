#version 450

layout(location = 0) out vec4 color;

float f() { return 2.0; }

void main() {
    color = vec4(f());
}
// ---- Fragment; reads: shadow=none
