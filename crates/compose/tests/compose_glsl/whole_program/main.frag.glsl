#version 450
#extension GL_GOOGLE_include_directive : require

// The lit surface.

#include "shadow/compare.glsl"
#include <lamplight/brdf/lambert.glsl>

struct Light {
    vec4 position;
    vec3 color; // linear
    float range;
};

/* One block for all lights. */
layout(std140, set = 0, binding = 0) uniform Lights {
    Light lights[MAX_LIGHTS];
    int count;
} u;

layout(location = 0) in vec3 normal;
layout(location = 1) in vec3 unused_input;
layout(location = 0) out vec4 color;

#if SHADOW != SHADOW_NONE
layout(set = 1, binding = 0) uniform texture2D shadow_map;
layout(set = 1, binding = 1) uniform samplerShadow shadow_sampler;
#endif

void main() {
    vec3 n = normalize(normal);
#if TWO_SIDED
    // Faces seen from behind are lit from behind.
    n = gl_FrontFacing ? n : -n;
#endif
    vec3 sum = vec3(0.0);
    for (int i = 0; i < min(u.count, MAX_LIGHTS); ++i) {
        sum += u.lights[i].color * lambert(n, u.lights[i].position.xyz);
    }
#if SHADOW == SHADOW_PCF_3X3
    sum *= pcf_3x3(shadow_map, shadow_sampler, vec3(0.5), TEXEL);
#elif SHADOW == SHADOW_HARD
    sum *= hard(shadow_map, shadow_sampler, vec3(0.5));
#endif
    color = vec4(sum, 1.0);
}
