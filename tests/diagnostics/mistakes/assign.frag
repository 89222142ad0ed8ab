#version 450
#include <lamplight/math/safe.glsl>
layout(location = 0) out vec4 colour;
void main() {
    vec3 c = 1.0;
    colour = vec4(safe_normalize(c), 1.0);
}
