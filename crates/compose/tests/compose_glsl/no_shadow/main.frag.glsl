#version 450
layout(location = 0) out vec4 color;
#if SHADOW == SHADOW_HARD
layout(set = 0, binding = 0) uniform texture2D map;
#endif
#if SHADOW == SHADOW_HARD && MAX_LIGHTS > 2
float f() { return 1.0; }
#else
float f() { return 2.0; }
#endif
void main() {
    color = vec4(f());
}
