#version 450

layout(location = 0) out vec4 color;

void main() {
    float a = 3.14159;
    float b = (2.0 * 3.14159) ;
    a = a * 2.0; a += 3.14159;
    color = vec4(a, b, -3.14159, 1.0-3.14159);
}
// ---- Fragment; reads: 
// `3.14159` from main.frag.glsl:9:15 `PI`
// `a * 2` from main.frag.glsl:11:5 `STATEMENT`
