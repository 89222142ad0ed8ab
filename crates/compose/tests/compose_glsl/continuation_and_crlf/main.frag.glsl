#version 450
#define LONG(a, b) \
    (a + \
     b)
layout(location = 0) out vec4 color;

// A comment that goes on \
   here.
float split\
name() { return 1.0; }
void main() {
    float x = LONG(1.0,
        2.0) \
        + 1.0;


    color = vec4(x, splitname(), 0.0, 1.0);
}
