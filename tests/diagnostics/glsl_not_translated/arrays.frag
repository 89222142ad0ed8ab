#version 450
layout(location = 0) in vec4 v;
layout(location = 0) out vec4 c;
struct Row { float cells[2][3]; };
layout(set = 0, binding = 0) uniform Block { vec4 rows[2][3]; } block;
float sum(float w[2][2]) { return w[0][0]; }
float first(float w[2]) { return w[0]; }
void main() {
    Row row;
    float[2] a[3];
    vec4 fine[2];
    fine[0][1] = first(float[2](1.0, 2.0));
    c = fine[0] + block.rows[1][1] + row.cells[1][2] + sum(a);
}
