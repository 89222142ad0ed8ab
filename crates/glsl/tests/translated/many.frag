#version 450
#extension GL_EXT_nonuniform_qualifier : require
layout(set = 0, binding = 0) uniform sampler2D pictures[3];
layout(location = 0) in vec2 uv;
layout(location = 1) flat in int which;
layout(location = 0) out vec4 color;
void main() {
    color = texture(pictures[nonuniformEXT(which)], uv) + textureLod(pictures[which - 1], uv, 0.0);
}
