//! Phase functions: how much of the light that a particle scatters goes into each direction.
//!
//! `cos_theta` is the cosine of the scattering angle, by which the light is turned, with 1 straight on: `dot(-l, v)` for `l` towards the light and `v` towards the viewer. All are shares per steradian: their integral over the sphere is 1.
//!
//! Made from `phase.wesl` by `cargo xtask docs`: edit that, not this file.

#ifndef LAMPLIGHT_FOG_PHASE_GLSL
#define LAMPLIGHT_FOG_PHASE_GLSL

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

/// Henyey and Greenstein's phase function, for particles with a given mean cosine of the scattering angle.
///
/// Parameters: `cos_theta` cosine of the angle by which the light is turned, [-1, 1]; `g` mean cosine, (-1, 1): above 0 forwards, 0 evenly.
/// Returns: `(1 - g^2)/(4*pi*(1 + g^2 - 2*g*cos_theta)^1.5)`, 1/sr.
/// Source: Henyey, Greenstein, "Diffuse Radiation in the Galaxy", 1941, equation 2.
/// Edges: `cos_theta` is clamped to [-1, 1], `g` to [-0.999, 0.999].
/// Error model: relative 2^-20.
float hg(float cos_theta, float g) {
    float a = clamp(g, -0.999, 0.999);
    float along = clamp(cos_theta, -1.0, 1.0) * (a >= 0.0 ? 1.0 : -1.0);
    // 1 + g^2 - 2*g*c as a sum of what has one sign.
    float size = abs(a);
    float d = (1.0 - size) * (1.0 - size) + 2.0 * size * (1.0 - along);
    return 0.07957747 * (1.0 - size) * (1.0 + size) / (d * sqrt(d));
}

/// Scattering by particles far smaller than the wavelength: air.
///
/// Parameters: `cos_theta` cosine of the angle by which the light is turned, [-1, 1].
/// Returns: `3/(16*pi)*(1 + cos_theta^2)`, 1/sr.
/// Source: Rayleigh, "On the Light from the Sky", 1871.
/// Edges: clamped to [-1, 1].
/// Error model: 2 ULP.
float rayleigh_phase(float cos_theta) {
    float c = clamp(cos_theta, -1.0, 1.0);
    return 0.05968310 * (1.0 + c * c);
}

/// Henyey and Greenstein's function with a share of Rayleigh's shape.
///
/// Parameters: `cos_theta` cosine of the angle by which the light is turned, [-1, 1]; `g` asymmetry, (-1, 1); `alpha` weight of Rayleigh's shape, at least 0: 0 gives `hg`, 1 gives `cornette_shanks`.
/// Returns: `hg*(1 + alpha*cos_theta^2)/(1 + alpha*(1 + 2*g^2)/3)`, 1/sr.
/// Source: Draine, "Scattering by Interstellar Dust Grains. I. Optical and Ultraviolet", 2003, equation 5.
/// Edges: as for `hg`; a negative `alpha` counts as 0, above 1e6 as that.
/// Error model: relative 2^-20.
float draine(float cos_theta, float g, float alpha) {
    float c = clamp(cos_theta, -1.0, 1.0);
    float a = clamp(g, -0.999, 0.999);
    float share = clamp(alpha, 0.0, 1e6);
    return hg(c, a) * (1.0 + share * c * c) / (1.0 + share * (1.0 + 2.0 * a * a) / 3.0);
}

/// Cornette and Shanks' phase function: Henyey and Greenstein's with Rayleigh's shape, for haze and small drops.
///
/// Parameters: `cos_theta` cosine of the angle by which the light is turned, [-1, 1]; `g` asymmetry, (-1, 1): 0 is Rayleigh's function.
/// Returns: `hg*3/2*(1 + cos_theta^2)/(2 + g^2)`, 1/sr.
/// Source: Cornette, Shanks, "Physically Reasonable Analytic Expression for the Single-Scattering Phase Function", 1992, equation 8.
/// Edges: as for `hg`.
/// Error model: relative 2^-20.
float cornette_shanks(float cos_theta, float g) {
    return draine(cos_theta, g, 1.0);
}

/// Scattering by drops of water of a size, a blend that fits Mie's theory: fog and clouds.
///
/// Parameters: `cos_theta` cosine of the angle by which the light is turned, [-1, 1]; `diameter` of the drops, micrometres, [5, 50].
/// Returns: the phase function, 1/sr.
/// Source: Jendersie, d'Eon, "An Approximate Mie Scattering Function for Fog and Cloud Rendering", 2023, equations 4 to 7.
/// Edges: a `cos_theta` outside [-1, 1] and a `diameter` outside [5, 50] are clamped to it.
/// Error model: relative 2^-14: the peak's width is 1 - g, of which g leaves few digits.
float fog_droplet(float cos_theta, float diameter) {
    float d = clamp(diameter, 5.0, 50.0);
    float narrow = exp(-0.0990567 / (d - 1.67154));
    float wide = exp(-2.20679 / (d + 3.91029) - 0.428934);
    float alpha = exp(3.62489 - 8.29288 / (d + 5.52825));
    float share = exp(-0.599085 / (d - 0.641583) - 0.665888);
    return mix(hg(cos_theta, narrow), draine(cos_theta, wide, alpha), share);
}

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

#endif
