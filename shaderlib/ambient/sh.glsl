//! Ambient light from spherical harmonics: nine (or four) RGB coefficients of the radiance around a point,
//! ordered L00, L1m1, L10, L11, L2m2, L2m1, L20, L21, L22.
//!
//! The results are irradiance: an environment of constant radiance 1 gives pi. Divide by pi for a Lambert surface.

#ifndef LAMPLIGHT_AMBIENT_SH_GLSL
#define LAMPLIGHT_AMBIENT_SH_GLSL

/// Irradiance from nine coefficients of the radiance.
vec3 sh9_irradiance(vec3 n, vec3 sh[9]) {
    vec3 second = 0.429043 * sh[8] * (n.x * n.x - n.y * n.y) + sh[6] * (0.743125 * n.z * n.z - 0.247708);
    vec3 mixed = 0.858086 * (sh[4] * (n.x * n.y) + sh[7] * (n.x * n.z) + sh[5] * (n.y * n.z));
    vec3 first = 1.023328 * (sh[3] * n.x + sh[1] * n.y + sh[2] * n.z);
    return 0.886227 * sh[0] + first + mixed + second;
}

/// Irradiance from nine coefficients, without the negative light that ringing leaves.
vec3 sh9_irradiance_clamped(vec3 n, vec3 sh[9]) {
    return max(sh9_irradiance(n, sh), vec3(0.0));
}

/// Irradiance from the first four coefficients of the radiance: constant and linear bands.
vec3 sh4_irradiance(vec3 n, vec3 sh[4]) {
    return 0.886227 * sh[0] + 1.023328 * (sh[3] * n.x + sh[1] * n.y + sh[2] * n.z);
}

/// The nine real spherical harmonics of bands 0 to 2 in a direction.
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

#endif
