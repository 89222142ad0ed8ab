#version 300 es
#if GL_ES && __VERSION__ == 300 && !defined(VULKAN) && !defined(GL_core_profile)
precision highp float;
#endif
out vec4 color;
void main() {
    color = vec4(1.0);
}
