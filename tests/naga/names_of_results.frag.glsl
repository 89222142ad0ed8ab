#version 450
layout(location = 0) out vec4 o_color;
struct FragmentOutput { float x; };
void main() { FragmentOutput o = FragmentOutput(0.5); o_color = vec4(o.x); }
