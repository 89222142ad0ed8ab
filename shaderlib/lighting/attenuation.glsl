//! How light weakens with distance. Each function is one factor; multiply the ones you want.

#ifndef LAMPLIGHT_LIGHTING_ATTENUATION_GLSL
#define LAMPLIGHT_LIGHTING_ATTENUATION_GLSL

#include "../math/safe.glsl"

/// The reciprocal of a polynomial in the distance: constant, linear and quadratic attenuation.
float polynomial(float d, vec3 k) {
    float q = k.x + d * (k.y + d * k.z);
    if (!(q >= SMALLEST_NORMAL)) {
        return 1.0;
    }
    return 1.0 / q;
}

/// A straight line from 1 at the light to 0 at its radius.
float linear_radius(float d, float radius) {
    if (!(radius > 0.0)) {
        return 0.0;
    }
    return 1.0 - clamp(d / radius, 0.0, 1.0);
}

/// The inverse-square law, bounded near the light.
float inverse_square(float d2, float min_d2) {
    return 1.0 / max(max(d2, min_d2), SMALLEST_NORMAL);
}

/// A smooth window that brings any falloff to 0 at the range.
float window(float d2, float inv_range2) {
    float x = d2 * inv_range2;
    float w = clamp(1.0 - x * x, 0.0, 1.0);
    return w * w;
}

/// The range factor of glTF's punctual lights, without the inverse square.
float range_gltf(float d, float range) {
    if (!(range > 0.0)) {
        return 1.0;
    }
    float x = d / range;
    float x2 = x * x;
    return clamp(1.0 - x2 * x2, 0.0, 1.0);
}

/// A power of the distance, windowed by a cutoff distance, as three.js attenuates its lights.
float decay_cutoff(float d, float cutoff, float decay) {
    float falloff = 1.0 / max(safe_pow(d, decay), 0.01);
    if (!(cutoff > 0.0)) {
        return falloff;
    }
    float x = d / cutoff;
    return falloff * window(x * x, 1.0);
}

#endif
