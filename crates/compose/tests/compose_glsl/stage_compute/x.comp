#version 450
layout(local_size_x = 64) in;
layout(std430, set = 0, binding = 0) buffer Data { float data[]; };
void main() {
    data[gl_GlobalInvocationID.x] *= 2.0;
}
