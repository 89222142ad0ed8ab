#version 450
precision highp float;

const float PI = 3.14, TAU = 6.28;
const float UNUSED = 1.0;
const float[2] TABLE = float[2](1.0, 2.0), OTHER = float[2](3.0, 4.0);
const float DEAD_TABLE[2] = float[2](PI, TAU);

struct Used { float x; };
struct Nested { Used inner; };
struct Dead { Nested n; };

float overloaded(float x);
float overloaded(float x) { return x; }
vec3 overloaded(vec3 x) { return x; }
float dead(Dead d) { return d.n.inner.x + dead2(); }
float dead2() { return 1.0; }
float field_only(float x) { return x; }

layout(std140, set = 0, binding = 0) uniform A { float a; float a_array[2]; };
layout(std140, set = 0, binding = 1) uniform B { float b; } instance;
layout(std140, set = 0, binding = 2) uniform C { float c; } dead_instance;
layout(std140, set = 0, binding = 3) uniform D { float dead_member; };
layout(location = 0) in vec3 used_in;
layout(location = 1) flat in int dead_in;
layout(location = 0) out vec4 color;
layout(location = 1) out vec4 dead_color;

float global_state = PI;;

void main() {
    Nested nested = Nested(Used(1.0));
    global_state += overloaded(nested.inner.x) + TABLE[1];
    color = vec4(used_in, global_state + a_array[1] + instance.b);
}
