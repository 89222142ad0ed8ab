#version 450
#define NEG -1
#define DIV /
#define LESS <
#define DOT .
#define ID(x) x
layout(location = 0) out vec4 color;
void main() {
    int a = 1-NEG;
    int b = -NEG;
    int c = 1-MINUS;
    bool d = a LESS -b;
    float e = 4.0 DIV ID(2.0);
    int f = ID(a)ID(-)ID(-b);
    color = vec4(a + b + c, d ? e : 1.0, vec2(1.0)DOT x, f);
}
