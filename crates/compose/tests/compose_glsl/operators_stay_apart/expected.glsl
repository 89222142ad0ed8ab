#version 450

layout(location = 0) out vec4 color;

void main() {
    int a = 1- -1;
    int b = - -1;
    int c = 1- -1;
    bool d = a < -b;
    float e = 4.0 / 2.0;
    int f = a- -b;
    color = vec4(a + b + c, d ? e : 1.0, vec2(1.0). x, f);
}
// ---- Fragment; reads: minus=-1
