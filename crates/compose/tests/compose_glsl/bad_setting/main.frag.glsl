#version 450
#if SHADOW == SHADOW_HARD
#endif
layout(location = 0) out vec4 color;
void main() { color = vec4(float(SHADOW)); }
