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
/// Parameters: `v` any vector, any space and unit; `fallback` returned as it is, usually unit.
/// Returns: a vector of length 1 in the space of `v`, or `fallback`.
/// Source: WGSL specification, "normalize": the result is indeterminate for a zero vector.
/// Edges: `fallback` where the squared length is below 2^-126 or above 3e38: for lengths below 1.1e-19 (zero included) and above 1.7e19 (infinity included).
/// Error model: 2 ULP (inverse square root) + 2 ULP (sum of squares) + 0.5 ULP per component; relative 2^-125/|v|^2 more where a device takes squares below 2^-126 for 0, which shows in vectors shorter than 1e-15.
vec3 safe_normalize(vec3 v, vec3 fallback) {
    float size2 = dot(v, v);
    return size2 >= SMALLEST_NORMAL && size2 <= 3e38 ? v * inversesqrt(size2) : fallback;
}

/// `max(x, 0)` raised to the power `e`, with `0^0 = 1`.
///
/// Parameters: `x` base, any number; `e` exponent, at least 0.
/// Returns: a number of at least 0; in [0, 1] for `x` up to 1.
/// Source: WGSL specification, "pow": the result is indeterminate for a negative base, which lighting meets behind a surface.
/// Edges: 1 for `e` = 0, whatever `x`; else 0 for an `x` below 2^-126, but 3.2e38 for a negative `e`; never above 3.2e38.
/// Error model: relative `e*ln2*2^-21 + |t|*ln2*u + (3 + 2|t|)*u + e*rel(x)` with `t = e*log2(x)`, `u = 2^-23`.
float safe_pow(float x, float e) {
    // Not the logarithm of 0, but far enough from it for every exponent.
    float l = x >= SMALLEST_NORMAL ? log2(x) : -1e30;
    return exp2(min(e * l, 127.9));
}

/// The unit vector along `v`, or zero where `v` is zero: `safe_normalize` for vectors of an ordinary length.
///
/// Parameters: `v` a vector of zero length, or of a length from 1.1e-19 to 1.8e19, any space and unit.
/// Returns: a vector of length 1 in the space of `v`, or zero.
/// Source: WGSL specification, "normalize": the result is indeterminate for a zero vector.
/// Edges: zero for a zero `v`; a squared length below 2^-126 counts as that, which leaves a shorter vector; zero where the squared length overflows.
/// Error model: that of `safe_normalize`.
vec3 normalize_or_zero(vec3 v) {
    return v * inversesqrt(max(dot(v, v), SMALLEST_NORMAL));
}

/// A cosine raised to a power, as highlights and cones have it: `safe_pow` for bases up to 1.
///
/// Parameters: `c` cosine, [-1, 1]; `e` exponent, at least 0.
/// Returns: `max(c, 0)^e`, in [0, 1].
/// Source: as `safe_pow`.
/// Edges: 1 for an `e` of 0, as which a negative one counts; else 0 for a `c` below 2^-126; a `c` above 1 counts as 1.
/// Error model: that of `safe_pow`.
float cosine_power(float c, float e) {
    float l = c >= SMALLEST_NORMAL ? log2(c) : -1e30;
    return clamp(exp2(e * l), 0.0, 1.0);
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
