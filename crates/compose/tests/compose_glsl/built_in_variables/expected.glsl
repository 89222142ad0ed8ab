#version 460

layout(location = 0) flat out int id;

void main() {
    int column = int(gl_InstanceIndex) % 4;
    id = int(gl_VertexIndex) + int(gl_VertexIndex) - max(int(gl_BaseVertex), column);
    gl_Position = vec4(float(int(gl_VertexIndex) - 5), 0.0, 0.0, 1.0);
}
// ---- Vertex; reads: 
