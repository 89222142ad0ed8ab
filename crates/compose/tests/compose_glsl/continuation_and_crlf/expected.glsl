#version 450

layout(location = 0) out vec4 color;

// A comment that goes on \
   here.
float splitname() { return 1.0; }

void main() {
    float x = (1.0 + 2.0) + 1.0;

    color = vec4(x, splitname(), 0.0, 1.0);
}
// ---- Fragment; reads: 
// `color =` from main.frag.glsl:17:5 `color =`
