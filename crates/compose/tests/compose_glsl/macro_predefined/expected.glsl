#version 450

layout(location = 0) out vec4 color;

void main() {
    color = vec4(6, 0, 450, 1);
}
// ---- Fragment; reads: 
