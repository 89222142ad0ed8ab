#version 330 core
#if defined(VULKAN) || defined(GL_ES)
#error
#endif
#ifdef GL_core_profile
out vec4 color;
#endif
void main() {
    color = vec4(1.0);
}
