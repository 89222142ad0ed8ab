#version 450
layout(location = 0) in vec4 v;
layout(location = 0) out vec4 c;
layout(set = 0, binding = 0) uniform Lamp { vec4 tint; } lamps[2];
layout(push_constant) uniform Push { vec4 tint; } push;
void main() { c = lamps[1].tint + push.tint; }
