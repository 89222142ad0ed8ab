//! Arithmetic that has a value everywhere: no NaN, no infinity from ordinary inputs.
//!
//! Made from `safe.wesl` by `cargo xtask docs`: edit that, not this file.

#ifndef LAMPLIGHT_MATH_SAFE_GLSL
#define LAMPLIGHT_MATH_SAFE_GLSL

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

/// The smallest positive normal `f32`, 2^-126: a floor for denominators.
/// A smaller number may be flushed to zero, and its reciprocal may overflow.
const float SMALLEST_NORMAL = 1.1754944e-38;

/// The unit vector along `v`, or `fallback` where `v` has no direction.
///
/// The vector is scaled by its largest component first, so its squared length neither overflows nor vanishes.
///
/// Parameters: `v` any vector, any space and unit; `fallback` returned as it is, usually unit.
/// Returns: a vector of length 1 in the space of `v`, or `fallback`.
/// Source: scaling by the largest component: Blue, "A Portable Fortran Program to Find the Euclidean Norm of a Vector", 1978.
/// Edges: `fallback` where the largest component is below 2^-126 (zero included) or above 2^126 (infinity included).
/// Error model: 2.5 ULP (scaling) + 2 ULP (inverse square root) + 2 ULP (sum of squares) + 0.5 ULP per component.
vec3 safe_normalize(vec3 v, vec3 fallback) {
    float largest = max(max(abs(v.x), abs(v.y)), abs(v.z));
    if (!(largest >= SMALLEST_NORMAL && largest <= 8.507059e37)) {
        return fallback;
    }
    return normalize(v / largest);
}

/// `max(x, 0)` raised to the power `e`, with `0^0 = 1`.
///
/// Parameters: `x` base, any number; `e` exponent, at least 0.
/// Returns: a number of at least 0; in [0, 1] for `x` up to 1.
/// Source: WGSL specification, "pow": the result is indeterminate for a negative base, which lighting meets behind a surface.
/// Edges: 1 for `e` = 0, whatever `x`; else 0 for `x` at or below 0, for a negative `e` too; never above 3.4e38.
/// Error model: relative `e*ln2*2^-21 + |t|*ln2*u + (3 + 2|t|)*u + e*rel(x)` with `t = e*log2(x)`, `u = 2^-23`.
float safe_pow(float x, float e) {
    if (e == 0.0) {
        return 1.0;
    }
    if (!(x > 0.0)) {
        return 0.0;
    }
    return min(pow(x, e), 3.4e38);
}

/// Whether `x` is not a number, read from its bits.
///
/// A comparison such as `x != x` is folded away by some drivers; the bits are not.
///
/// Parameters: `x` any bit pattern.
/// Returns: true where the exponent is all ones and the mantissa is not zero.
/// Source: IEEE 754-2019, section 3.4.
/// Edges: false for both infinities, both zeros and subnormal numbers.
/// Error model: exact, as far as the bits of `x` reach the function: WGSL lets an implementation assume that none is NaN.
bool is_nan_bits(float x) {
    return (floatBitsToUint(x) & 0x7fffffffu) > 0x7f800000u;
}

/// A colour with every channel clamped to [0, 1].
///
/// Parameters: `c` linear colour, any range.
/// Returns: linear colour in [0, 1].
/// Source: Kessenich, Sellers, Shreiner, OpenGL Programming Guide, 9th edition, 2016, example 7.2: `min(colour, 1)` at the end of the shader.
/// Edges: negative channels become 0; NaN gives either bound.
/// Error model: exact.
vec3 saturate_color(vec3 c) {
    return clamp(c, vec3(0.0), vec3(1.0));
}

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

#endif
