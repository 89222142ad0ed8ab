#version 450
#include "shared.glsl"
#define SHADOWED (SHADOW != SHADOW_NONE)
layout(location = 0) out vec4 color;
void main() {
    color = vec4(fade(1.0));
#if SHADOWED
    color *= 0.5;
#elif SHADOW == SHADOW_NONE
    color *= 0.25;
#endif
#if SHADOW == SHADOW_NONE && TWO_SIDED
    color *= 0.125;
#endif
#if SHADOW == SHADOW_NONE || SHADOW == SHADOW_HARD
    color *= 0.75;
#endif
}
