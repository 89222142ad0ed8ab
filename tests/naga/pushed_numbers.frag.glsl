#version 450
layout(push_constant) uniform P { float alpha; } p;
layout(location = 0) out vec4 color;
void main() { color = vec4(p.alpha); }
