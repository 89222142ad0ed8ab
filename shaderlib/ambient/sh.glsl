//! Ambient light from spherical harmonics: nine (or four) RGB coefficients of the radiance around a point,
//! ordered L00, L1m1, L10, L11, L2m2, L2m1, L20, L21, L22.
//!
//! The results are irradiance: an environment of constant radiance 1 gives pi. Divide by pi for a Lambert surface.
//!
//! Made from `sh.wesl` by `cargo xtask docs`: edit that, not this file.

#ifndef LAMPLIGHT_AMBIENT_SH_GLSL
#define LAMPLIGHT_AMBIENT_SH_GLSL

#include "../math/safe.glsl"

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

/// Irradiance from nine coefficients of the radiance.
///
/// Parameters: `n` unit normal in the space of the coefficients; `sh` nine linear RGB coefficients of any sign.
/// Returns: irradiance, linear; may be below 0 for an environment of strong contrast.
/// Source: Ramamoorthi, Hanrahan, "An Efficient Representation for Irradiance Environment Maps", 2001, equation 13; Kessenich, Sellers, Shreiner, OpenGL Programming Guide, 9th edition, 2016, equation 7.1 and example 7.14.
/// Edges: a zero `n` gives `0.886227*L00 - 0.247708*L20`.
/// Error model: absolute 12*2^-23 of the sum of the terms' magnitudes.
vec3 sh9_irradiance(vec3 n, vec3 sh[9]) {
    vec3 second = 0.429043 * sh[8] * (n.x * n.x - n.y * n.y) + sh[6] * (0.743125 * n.z * n.z - 0.247708);
    vec3 mixed = 0.858086 * (sh[4] * (n.x * n.y) + sh[7] * (n.x * n.z) + sh[5] * (n.y * n.z));
    vec3 first = 1.023328 * (sh[3] * n.x + sh[1] * n.y + sh[2] * n.z);
    return 0.886227 * sh[0] + first + mixed + second;
}

/// Irradiance from nine coefficients, without the negative light that ringing leaves.
///
/// Parameters: `n` unit normal in the space of the coefficients; `sh` nine linear RGB coefficients of any sign.
/// Returns: `max(sh9_irradiance, 0)` per channel, linear, at least 0.
/// Source: as `sh9_irradiance`; the clamp because Grace Cathedral's blue reaches -0.0056.
/// Edges: 0 where the sum is negative; a zero `n` as for `sh9_irradiance`.
/// Error model: that of `sh9_irradiance`.
vec3 sh9_irradiance_clamped(vec3 n, vec3 sh[9]) {
    return max(sh9_irradiance(n, sh), vec3(0.0));
}

/// Irradiance from the first four coefficients of the radiance: constant and linear bands.
///
/// Parameters: `n` unit normal in the space of the coefficients; `sh` four linear RGB coefficients of any sign: L00, L1m1, L10, L11.
/// Returns: irradiance, linear; may be below 0 opposite a strong light.
/// Source: Ramamoorthi, Hanrahan, "An Efficient Representation for Irradiance Environment Maps", 2001, equation 13 without its quadratic terms.
/// Edges: a zero `n` gives `0.886227*L00`.
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

/// One channel of `sh4_irradiance_geomerics`.
///
/// Parameters: `n` unit normal; `constant` coefficient L00 of the channel; `axis` its coefficients L11, L1m1, L10: along x, y, z.
/// Returns: irradiance of the channel, linear, at least 0.
/// Source: Hazel, "Reconstructing Diffuse Lighting from Spherical Harmonic Data", Geomerics, 2015.
/// Edges: as for `sh4_irradiance_geomerics`.
/// Error model: relative 2^-18.
float geomerics_channel(vec3 n, float constant, vec3 axis) {
    float mean = 0.886227 * max(constant, 0.0);
    // Half of the irradiance's linear band over its mean: 1 for light from one direction.
    float band = 0.511664 * length(axis);
    float ratio = 1.0;
    if (band < mean) {
        ratio = band / mean;
    }
    float base = (1.0 - ratio) / (1.0 + ratio);
    float power = 1.0 + 2.0 * ratio;
    float q = 0.5 + 0.5 * dot(n, normalize_or_zero(axis));
    return mean * (base + (1.0 - base) * (power + 1.0) * cosine_power(q, power));
}

/// Irradiance from four coefficients that is never negative: a nonlinear lobe in place of the linear band.
///
/// Parameters: `n` unit normal in the space of the coefficients; `sh` four linear RGB coefficients of the radiance, of any sign: L00, L1m1, L10, L11.
/// Returns: irradiance, linear, at least 0; its mean over all directions is `0.886227*L00`, its largest value four times that.
/// Source: Hazel, "Reconstructing Diffuse Lighting from Spherical Harmonic Data", Geomerics, 2015: `R0*(a + (1 - a)*(p + 1)*q^p)`, each channel about its own axis.
/// Edges: the constant term where a channel has no direction; 0 where its constant is 0 or less; a linear band that is longer than that of light from one direction counts as that long; a zero `n` counts as at a right angle to the directions of all channels.
/// Error model: relative 2^-18.
vec3 sh4_irradiance_geomerics(vec3 n, vec3 sh[4]) {
    vec3 axis_r = vec3(sh[3].x, sh[1].x, sh[2].x);
    vec3 axis_g = vec3(sh[3].y, sh[1].y, sh[2].y);
    vec3 axis_b = vec3(sh[3].z, sh[1].z, sh[2].z);
    return vec3(geomerics_channel(n, sh[0].x, axis_r), geomerics_channel(n, sh[0].y, axis_g), geomerics_channel(n, sh[0].z, axis_b));
}

/// Irradiance from four coefficients and a guess of the next band from them.
///
/// Parameters: `n` unit normal in the space of the coefficients; `sh` four linear RGB coefficients of the radiance, of any sign: L00, L1m1, L10, L11.
/// Returns: irradiance, linear; may be below 0 opposite a strong light.
/// Source: Roughton, Sloan, Silvennoinen, Iwanicki, Shirley, "ZH3: Quadratic Zonal Harmonics", 2024: band 2 is `L00*(0.08*r + 0.6*r^2)` about the axis of the luminance, with r the linear band along it over L00.
/// Edges: `sh4_irradiance` where the luminance has no direction, and for channels whose constant is 0 or less; a zero `n` counts as at a right angle to the luminance's direction.
/// Error model: absolute 2^-20 of the sum of the terms' magnitudes.
vec3 sh4_irradiance_zh3(vec3 n, vec3 sh[4]) {
    vec3 luma = vec3(0.2126, 0.7152, 0.0722);
    vec3 linear = vec3(dot(sh[3], luma), dot(sh[1], luma), dot(sh[2], luma));
    vec3 axis = normalize_or_zero(linear);
    vec3 along = abs(sh[3] * axis.x + sh[1] * axis.y + sh[2] * axis.z);
    vec3 constant = max(sh[0], vec3(0.0));
    // L00*(0.08*r + 0.6*r^2), with r no more than light from one direction has.
    vec3 ratio = min(along / max(constant, vec3(1e-30)), vec3(1.7320508));
    vec3 band = constant * (ratio * (0.08 + 0.6 * ratio));
    float mu = dot(n, axis);
    return sh4_irradiance(n, sh) + band * (0.247708 * (3.0 * mu * mu - 1.0));
}

/// The share of a band that a window leaves, against ringing.
///
/// Parameters: `band` 0 for the constant, 1 for the linear one, and so on; `width` of the window, bands, above 0: smaller ones blur more.
/// Returns: `(1 + cos(pi*band/width))/2`, [0, 1]: a factor of the band's coefficients.
/// Source: Sloan, "Stupid Spherical Harmonics (SH) Tricks", 2008, "Windowing": the Hanning window.
/// Edges: 1 for a `band` of 0 or below, whatever the `width`; 0 for every other band from `width` on, so for all of them where `width` is 0 or below.
/// Error model: absolute 2^-12, of which the bound of WGSL for sines is all but 2^-20.
float sh_window(float band, float width) {
    if (!(band > 0.0)) {
        return 1.0;
    }
    if (!(band < width)) {
        return 0.0;
    }
    return 0.5 + 0.5 * cos(3.1415927 * (band / width));
}

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

#endif
