#version 450

precision highp float;

const float PI = 3.14, TAU = 6.28;

const float[2] TABLE = float[2](1.0, 2.0), OTHER = float[2](3.0, 4.0);

struct Used { float x; };

struct Nested { Used inner; };

float overloaded(float x);

float overloaded(float x) { return x; }

vec3 overloaded(vec3 x) { return x; }

layout(std140, set = 0, binding = 0) uniform A { float a; float a_array[2]; };

layout(std140, set = 0, binding = 1) uniform B { float b; } instance;

layout(location = 0) in vec3 used_in;

layout(location = 0) out vec4 color;

float global_state = PI;

void main() {
    Nested nested = Nested(Used(1.0));
    global_state += overloaded(nested.inner.x) + TABLE[1];
    color = vec4(used_in, global_state + a_array[1] + instance.b);
}
// ---- Fragment; reads: 
