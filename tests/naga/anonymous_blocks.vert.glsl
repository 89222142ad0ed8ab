#version 450
layout(set = 0, binding = 0) uniform Globals { mat4 view; };
layout(set = 0, binding = 1) uniform Object { mat4 world; vec4 tint; };
layout(location = 0) in vec2 position;
layout(location = 0) out vec4 color;
void main() {
    color = tint;
    gl_Position = view * world * vec4(position, 0.0, 1.0);
    gl_Position.z = (gl_Position.z + gl_Position.w) / 2.0;
}
