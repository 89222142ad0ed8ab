//! Arithmetic that has a value everywhere: no NaN, no infinity from ordinary inputs.

#ifndef LAMPLIGHT_MATH_SAFE_GLSL
#define LAMPLIGHT_MATH_SAFE_GLSL

/// The smallest positive normal `f32`, 2^-126: a floor for denominators.
/// A smaller number may be flushed to zero, and its reciprocal may overflow.
const float SMALLEST_NORMAL = 1.1754944e-38;

/// The unit vector along `v`, or `fallback` where `v` has no direction.
vec3 safe_normalize(vec3 v, vec3 fallback) {
    float largest = max(max(abs(v.x), abs(v.y)), abs(v.z));
    if (!(largest >= SMALLEST_NORMAL && largest <= 8.507059e37)) {
        return fallback;
    }
    return normalize(v / largest);
}

/// `max(x, 0)` raised to the power `e`, with `0^0 = 1`.
float safe_pow(float x, float e) {
    if (e == 0.0) {
        return 1.0;
    }
    if (!(x > 0.0)) {
        return 0.0;
    }
    return pow(x, e);
}

/// Whether `x` is not a number, read from its bits.
bool is_nan_bits(float x) {
    return (floatBitsToUint(x) & 0x7fffffffu) > 0x7f800000u;
}

/// A colour with every channel clamped to [0, 1].
vec3 saturate_color(vec3 c) {
    return clamp(c, vec3(0.0), vec3(1.0));
}

#endif
