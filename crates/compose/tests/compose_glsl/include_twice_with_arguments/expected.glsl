#version 450

// Twice.
float f(float x) {
    return x + x;
}

// Twice.
vec3 f(vec3 x) {
    return x + x;
}

layout(location = 0) out vec4 color;

void main() { color = vec4(f(vec3(1.0)), f(1.0)); }
// ---- Fragment; reads: 
