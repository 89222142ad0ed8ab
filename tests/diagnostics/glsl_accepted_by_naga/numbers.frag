#version 450

layout(location = 0) out vec4 lit;

void main() {
    uint mask = 4294967296u;
    lit = vec4(mask);
}
