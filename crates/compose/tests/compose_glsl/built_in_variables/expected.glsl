#version 460

layout(location = 0) flat out int id;

void main() {
    int column = gl_InstanceIndex % 4;
    id = gl_VertexIndex + int(gl_VertexIndex) - max(gl_BaseVertex, column);
    gl_Position = vec4(float(gl_VertexIndex - 5), 0.0, 0.0, 1.0);
}
// ---- Vertex; reads: 
