#version 450

layout(location = 0) in vec3 position;

layout(location = 0) flat out int id;

invariant gl_Position;

void main() {
    id = int(gl_InstanceIndex);
    gl_Position = vec4(position, 1.0);
}
// ---- Vertex; reads: 
