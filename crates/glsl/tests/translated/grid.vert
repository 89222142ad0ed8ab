#version 450
layout(location = 0) in vec3 position;
layout(location = 1) in mat3 turn;
layout(location = 0) out Surface { vec3 normal; flat int row; } surface;
out gl_PerVertex { vec4 gl_Position; float gl_PointSize; };
layout(push_constant) uniform Push { layout(offset = 16) mat4 view; float scale; } push;
layout(set = 1, binding = 2, row_major) uniform Camera { mat4 projection; mat2 small; };
layout(constant_id = 3) const int COLUMNS = 4;
void main() {
    int row = gl_InstanceIndex / COLUMNS - 2;
    vec3 offset = vec3(gl_InstanceIndex % COLUMNS, row, 0);
    surface.normal = turn[2] * small[0][1];
    surface.row = row;
    gl_PointSize = 2.0;
    gl_Position = projection * push.view * vec4(position * push.scale + offset, 1.0);
}
