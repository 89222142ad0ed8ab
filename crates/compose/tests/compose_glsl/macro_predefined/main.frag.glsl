#version 450
#if __VERSION__ == 450 && VULKAN == 100 && GL_core_profile == 1 && !defined(GL_ES)
layout(location = 0) out vec4 color;
#endif
void main() {
    color = vec4(__LINE__, __FILE__, __VERSION__, 1);
}
