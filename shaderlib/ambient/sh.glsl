//! Ambient light from spherical harmonics: nine (or four) RGB coefficients of the radiance around a point,
//! ordered L00, L1m1, L10, L11, L2m2, L2m1, L20, L21, L22.
//!
//! The results are irradiance: an environment of constant radiance 1 gives pi. Divide by pi for a Lambert surface.

#ifndef LAMPLIGHT_AMBIENT_SH_GLSL
#define LAMPLIGHT_AMBIENT_SH_GLSL

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

/// Irradiance from nine coefficients of the radiance.
///
/// Parameters: `n` unit normal in the space of the coefficients; `sh` nine linear RGB coefficients.
/// Returns: irradiance, linear; may be below 0 for an environment of strong contrast.
/// Source: Ramamoorthi, Hanrahan, "An Efficient Representation for Irradiance Environment Maps", 2001, equation 13; Shreiner et al., OpenGL Programming Guide, 8th edition, 2013, equation 7.1 and example 7.14.
/// Edges: a zero normal gives `0.886227*L00 - 0.247708*L20`.
/// Error model: absolute 12*2^-23 of the sum of the terms' magnitudes.
vec3 sh9_irradiance(vec3 n, vec3 sh[9]) {
    vec3 second = 0.429043 * sh[8] * (n.x * n.x - n.y * n.y) + sh[6] * (0.743125 * n.z * n.z - 0.247708);
    vec3 mixed = 0.858086 * (sh[4] * (n.x * n.y) + sh[7] * (n.x * n.z) + sh[5] * (n.y * n.z));
    vec3 first = 1.023328 * (sh[3] * n.x + sh[1] * n.y + sh[2] * n.z);
    return 0.886227 * sh[0] + first + mixed + second;
}

/// Irradiance from nine coefficients, without the negative light that ringing leaves.
///
/// Parameters: `n` unit normal in the space of the coefficients; `sh` nine linear RGB coefficients.
/// Returns: `max(sh9_irradiance, 0)` per channel, linear, at least 0.
/// Source: as `sh9_irradiance`; the clamp because Grace Cathedral's blue reaches -0.0056.
/// Edges: 0 where the sum is negative.
/// Error model: that of `sh9_irradiance`.
vec3 sh9_irradiance_clamped(vec3 n, vec3 sh[9]) {
    return max(sh9_irradiance(n, sh), vec3(0.0));
}

/// Irradiance from the first four coefficients of the radiance: constant and linear bands.
///
/// Parameters: `n` unit normal in the space of the coefficients; `sh` four linear RGB coefficients: L00, L1m1, L10, L11.
/// Returns: irradiance, linear; may be below 0 opposite a strong light.
/// Source: Ramamoorthi, Hanrahan, "An Efficient Representation for Irradiance Environment Maps", 2001, equation 13 without its quadratic terms.
/// Edges: a zero normal gives `0.886227*L00`.
/// Error model: absolute 6*2^-23 of the sum of the terms' magnitudes.
vec3 sh4_irradiance(vec3 n, vec3 sh[4]) {
    return 0.886227 * sh[0] + 1.023328 * (sh[3] * n.x + sh[1] * n.y + sh[2] * n.z);
}

/// The nine real spherical harmonics of bands 0 to 2 in a direction.
///
/// Parameters: `n` unit direction, in the space of the coefficients.
/// Returns: the basis functions in the library's order, orthonormal over the sphere; each in [-1.1, 1.1].
/// Source: Ramamoorthi, Hanrahan, "An Efficient Representation for Irradiance Environment Maps", 2001, equation 3.
/// Edges: a zero direction gives the constant and -0.315392 for L20.
/// Error model: absolute 4*2^-23.
float[9] sh9_basis(vec3 n) {
    return float[9](
        0.282095,
        0.488603 * n.y,
        0.488603 * n.z,
        0.488603 * n.x,
        1.092548 * n.x * n.y,
        1.092548 * n.y * n.z,
        0.315392 * (3.0 * n.z * n.z - 1.0),
        1.092548 * n.x * n.z,
        0.546274 * (n.x * n.x - n.y * n.y)
    );
}

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

#endif
