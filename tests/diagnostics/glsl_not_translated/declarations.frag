#version 450
layout(location = 0) in vec4 v;
layout(location = 0) out vec4 c;
float total;
float total;
float f(float x) { float x = 2.0; return x; }
void main() {
    if (v.x > 1.0) float y = 2.0;
    for (int i = 0; i < 2; i++) { int i = 3; c.x += float(i); }
    for (int i = 0; i < 2; i++) { { int i = 3; c.x += float(i); } }
    for (int i = 0; i < 2; i++) int k = i;
    c = vec4(f(total));
}
