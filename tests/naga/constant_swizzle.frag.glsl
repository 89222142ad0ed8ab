#version 450
#define MIX2(c) mix(c.xy, c.xy, 0.5)
const vec2 blank = MIX2(vec2(0.0, 1.0));
layout(location = 0) out vec4 color;
void main() { color = vec4(blank, 0.0, 1.0); }
