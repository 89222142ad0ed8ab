//! From linear light to what a screen shows: transfer functions, tone curves, fog.

#ifndef LAMPLIGHT_COLOR_TRANSFER_GLSL
#define LAMPLIGHT_COLOR_TRANSFER_GLSL

#include "../math/safe.glsl"

/// The sRGB code of one linear channel.
float srgb_from_linear_channel(float x) {
    if (!(x > 0.0031308)) {
        return 12.92 * max(x, 0.0);
    }
    return 1.055 * safe_pow(x, 0.41666667) - 0.055;
}

/// The linear value of one sRGB channel.
float linear_from_srgb_channel(float x) {
    if (!(x > 0.04045)) {
        return max(x, 0.0) / 12.92;
    }
    return safe_pow((x + 0.055) / 1.055, 2.4);
}

/// The sRGB code of a linear colour.
vec3 srgb_from_linear(vec3 c) {
    return vec3(srgb_from_linear_channel(c.x), srgb_from_linear_channel(c.y), srgb_from_linear_channel(c.z));
}

/// The linear value of an sRGB colour.
vec3 linear_from_srgb(vec3 c) {
    return vec3(linear_from_srgb_channel(c.x), linear_from_srgb_channel(c.y), linear_from_srgb_channel(c.z));
}

/// Reinhard's tone curve, per channel.
vec3 tonemap_reinhard(vec3 c) {
    vec3 x = max(c, vec3(0.0));
    return x / (1.0 + x);
}

/// A fit to the filmic tone curve of ACES, per channel.
vec3 tonemap_aces(vec3 c) {
    vec3 x = clamp(c, vec3(0.0), vec3(65504.0));
    vec3 y = x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
    return clamp(y, vec3(0.0), vec3(1.0));
}

/// The clear share of a view through fog that thickens evenly between two distances.
float fog_linear(float d, float start, float end) {
    if (!(end > start)) {
        return d <= end ? 1.0 : 0.0;
    }
    return clamp((end - d) / (end - start), 0.0, 1.0);
}

/// The clear share of a view through fog of even density.
float fog_exp(float d, float density) {
    return exp(-max(density * d, 0.0));
}

/// The clear share of a view through fog that is thin nearby.
float fog_exp2(float d, float density) {
    float x = density * d;
    return exp(-x * x);
}

#endif
