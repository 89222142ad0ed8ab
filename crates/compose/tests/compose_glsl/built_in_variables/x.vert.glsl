#version 460
// The block only repeats what a vertex stage has.
out gl_PerVertex {
    vec4 gl_Position;
};
layout(location = 0) flat out int id;
#define INDEX gl_VertexIndex
#ifdef gl_VertexIndex
#error it is no macro
#endif
void main() {
    int column = gl_InstanceIndex % 4;
    id = INDEX + int(gl_VertexIndex) - max(gl_BaseVertex, column);
    gl_Position = vec4(float(gl_VertexIndex - 5), 0.0, 0.0, 1.0);
}
