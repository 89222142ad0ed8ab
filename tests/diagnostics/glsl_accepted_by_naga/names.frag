#version 450

layout(set = 0, binding = 0) uniform Lamp {
    vec4 colour;
};
layout(set = 0, binding = 1) uniform Fog {
    vec4 colour;
};

layout(location = 0) out vec4 lit;

void main() {
    float input = 0.5;
    lit = colour * input;
}
