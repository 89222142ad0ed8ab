#version 450
#define SQUARE(x) ((x) * (x))
#define ADD(a, b) (a + b)
#define NOTHING() 4.0
#define FIRST(a, b) a
#define CALL ADD
layout(location = 0) out vec4 color;
float ADD = 1.0;
void main() {
    float a = SQUARE(SQUARE(2.0));
    float b = ADD(ADD(1.0, 2.0), SQUARE (3.0));
    float c = NOTHING() + NOTHING( );
    float d = FIRST((1.0, 2.0), 3.0) + ADD(vec2(1.0, 2.0).x, 1.0);
    float e = CALL(1.0, a) + ADD;
    float f = ADD(
        a, // the first
        /* the second */ b
    );
    float g = SQUARE((a) + 1.0);
    color = vec4(a + b, c + d, e + f, g);
}
