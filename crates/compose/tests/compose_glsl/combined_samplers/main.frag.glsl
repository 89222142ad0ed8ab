#version 450
#ifdef LAMPLIGHT_COMBINED_SAMPLERS
#define SHADOW_MAP_2D(map) sampler2DShadow map
#define SHADOW_ARG_2D(map) map
#define SHADOW_AT_2D(map) map
#else
#define SHADOW_MAP_2D(map) texture2D map, samplerShadow map##_sampler
#define SHADOW_ARG_2D(map) map, map##_sampler
#define SHADOW_AT_2D(map) sampler2DShadow(map, map##_sampler)
#endif
float hard(SHADOW_MAP_2D(m), vec3 uvd) {
    return texture(SHADOW_AT_2D(m), uvd);
}
float twice(SHADOW_MAP_2D(m), vec3 uvd) {
    return hard(SHADOW_ARG_2D(m), uvd) * 2.0;
}
layout(set = 0, binding = 0) uniform texture2D shadow;
layout(set = 0, binding = 1) uniform samplerShadow shadow_sampler;
layout(location = 0) out vec4 color;
void main() {
    color = vec4(twice(SHADOW_ARG_2D(shadow), vec3(0.5)));
}
