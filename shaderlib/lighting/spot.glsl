//! The cone of a spot light: a factor from the cosine `c = dot(-l, axis)` between the ray and the axis.

#ifndef LAMPLIGHT_LIGHTING_SPOT_GLSL
#define LAMPLIGHT_LIGHTING_SPOT_GLSL

#include "../math/safe.glsl"

/// 1 inside the cone and on its edge, 0 outside.
float cone_hard(float c, float cutoff) {
    return c >= cutoff ? 1.0 : 0.0;
}

/// 1 inside the cone, 0 on its edge and outside.
float cone_hard_exclusive(float c, float cutoff) {
    return c > cutoff ? 1.0 : 0.0;
}

/// A power of the cosine inside the cone, 0 outside.
float cone_exponent(float c, float cutoff, float e) {
    if (!(c >= cutoff)) {
        return 0.0;
    }
    return safe_pow(c, e);
}

/// A smooth step from 0 at the outer cone to 1 at the inner one.
float cone_smooth(float c, float inner, float outer) {
    if (!(inner > outer)) {
        return c >= outer ? 1.0 : 0.0;
    }
    float t = clamp((c - outer) / (inner - outer), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

/// A squared ramp in the cosine, with scale and offset worked out on the host.
float cone_scale_offset(float c, float scale, float offset) {
    float t = clamp(c * scale + offset, 0.0, 1.0);
    return t * t;
}

#endif
