#version 450

// One tap.
float hard(texture2D map, samplerShadow smp, vec3 uvd) {
    return texture(sampler2DShadow(map, smp), uvd);
}

// Nine taps,
// one texel apart.
float pcf_3x3(texture2D map, samplerShadow smp, vec3 uvd, float texel) {
    float sum = 0.0;
    for (int y = -1; y <= 1; ++y) {
        for (int x = -1; x <= 1; ++x) {
            sum += hard(map, smp, uvd + vec3(vec2(x, y) * texel, 0.0));
        }
    }
    return sum / 9.0;
}

float saturate_(float x) {
    return clamp(x, 0.0, 1.0);
}

// Cosine, clamped.
float lambert(vec3 n, vec3 l) {
    return saturate_(dot(n, l));
}

struct Light {
    vec4 position;
    vec3 color; // linear
    float range;
};

/* One block for all lights. */
layout(std140, set = 0, binding = 0) uniform Lights {
    Light lights[4];
    int count;
} u;

layout(location = 0) in vec3 normal;

layout(location = 0) out vec4 color;

layout(set = 1, binding = 0) uniform texture2D shadow_map;

layout(set = 1, binding = 1) uniform samplerShadow shadow_sampler;

void main() {
    vec3 n = normalize(normal);
    // Faces seen from behind are lit from behind.
    n = gl_FrontFacing ? n : -n;
    vec3 sum = vec3(0.0);
    for (int i = 0; i < min(u.count, 4); ++i) {
        sum += u.lights[i].color * lambert(n, u.lights[i].position.xyz);
    }
    sum *= pcf_3x3(shadow_map, shadow_sampler, vec3(0.5), (1.0 / 512.0));
    color = vec4(sum, 1.0);
}
// ---- Fragment; reads: shadow=pcf_3x3 two_sided=true max_lights=4
// `pcf_3x3(` from shadow/compare.glsl:13:7 `pcf_3x3(`
// `lights[4]` from main.frag.glsl:17:11 `lights[MAX_LIGHTS]`
// `1.0 / 512.0` from main.frag.glsl:41:59 `TEXEL`
