#version 450
layout(location = 0) in vec4 v;
layout(location = 0) out vec4 c;
struct Cascade { float splits[2]; float bias; };
layout(set = 0, binding = 0) uniform Shadow { float weights[4]; vec4 tint; } shadow;
layout(set = 0, binding = 1) uniform Cascades { Cascade each[2]; } cascades;
layout(set = 0, binding = 2) uniform Fine { vec4 weights[4]; mat3 turn; vec3 at[2]; } fine;
void main() {
    c = shadow.tint * shadow.weights[int(v.x)] + cascades.each[1].splits[1] + fine.weights[1].x;
}
