#version 450
struct S { float tint; };
float tint(float x) { return x; }
layout(location = 0) out vec4 color;
void main() {
    S s = S(1.0);
    color = vec4(s.tint, s . tint, 0.0, 1.0);
}
