#version 410 core
#extension GL_ARB_shader_storage_buffer_object : enable
// Everything that the stage could write, of which it writes a part.
layout(std140, column_major) uniform;
layout(std430, row_major) buffer;
layout(location = 0) in vec4 point;
layout(binding = 0) readonly buffer Turns {
    mat4 turns[];
};
out gl_PerVertex {
    vec4 gl_Position;
    float gl_PointSize;
    float gl_ClipDistance[];
};

void main() {
    gl_Position = turns[gl_InstanceID] * point;
}
