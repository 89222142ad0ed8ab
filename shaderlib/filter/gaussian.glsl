//! The separable Gaussian blur of variance shadow maps.

#ifndef LAMPLIGHT_FILTER_GAUSSIAN_GLSL
#define LAMPLIGHT_FILTER_GAUSSIAN_GLSL

#include "sampling.glsl"

/// The weight of a tap of the 21-tap kernel.
float gaussian21(int i) {
    float x = float(i);
    return abs(i) <= 10 ? 0.14107424 * exp(-x * x / 16.0) : 0.0;
}

/// One pass of the 21-tap blur along a direction.
vec4 blur21(LAMPLIGHT_COLOR_MAP(map, smp), vec2 uv, vec2 direction) {
    vec2 stride = direction / vec2(textureSize(LAMPLIGHT_COLOR_SAMPLER(map, smp), 0));
    vec4 sum = vec4(0.0);
    for (int i = -10; i <= 10; i++) {
        sum += gaussian21(i) * textureLod(LAMPLIGHT_COLOR_SAMPLER(map, smp), uv + float(i) * stride, 0.0);
    }
    return sum;
}

#endif
