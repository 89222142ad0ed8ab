#version 450

layout(location = 0) out vec4 color;

float ADD = 1.0;

void main() {
    float a = ((((2.0) * (2.0))) * (((2.0) * (2.0))));
    float b = ((1.0 + 2.0) + ((3.0) * (3.0)));
    float c = 4.0 + 4.0;
    float d = (1.0, 2.0) + (vec2(1.0, 2.0).x + 1.0);
    float e = (1.0 + a) + ADD;
    float f = (a + b);
    float g = (((a) + 1.0) * ((a) + 1.0));
    color = vec4(a + b, c + d, e + f, g);
}
// ---- Fragment; reads: 
// `((a) + 1.0)` from main.frag.glsl:19:15 `SQUARE((a) + 1.0)`
