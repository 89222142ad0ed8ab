#version 450
layout(location = 0) in vec4 v;
layout(location = 0) out vec4 c;
void add_one(inout float x) { x += 1.0; }
void main() {
    float x[3] = float[3](1.0, 2.0, 3.0);
    int i = 0;
    x[i++] = 5.0;
    x[i++] += 5.0;
    add_one(x[i++]);
    c = vec4(x[0], x[1], x[2], 1.0);
}
