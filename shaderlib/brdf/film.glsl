//! Iridescence: the colours of a thin film over a material.
//!
//! Made from `film.wesl` by `cargo xtask docs`: edit that, not this file.

#ifndef LAMPLIGHT_BRDF_FILM_GLSL
#define LAMPLIGHT_BRDF_FILM_GLSL

#include "fresnel.glsl"
#include "specular.glsl"

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

/// The interference term for an optical path difference, integrated over the eye's three responses, as linear Rec. 709.
///
/// Each response is a Gaussian over the frequency, and the red one has a second lobe. Their Fourier transforms are cosines with Gaussian envelopes. The constants here are in turns and nanometres; the published ones are in metres.
///
/// Parameters: `difference` optical path difference, nanometres, [0, 1e6]; `phase` 1 or -1 for each channel: the sign of a cosine shifted by an even or odd number of half waves.
/// Returns: the interference term, (1.205, 0.948, 0.909) for no difference: the responses' own white.
/// Source: Belcour, Barla, "A Practical Extension to Microfacet Theory for the Modeling of Varying Iridescence", 2017, with the coefficients of its supplement; Khronos Group, KHR_materials_iridescence, 2022.
/// Edges: tends to 0 for differences beyond some micrometres; a negative `difference` counts as its magnitude; 0 for a `phase` of zeros.
/// Error model: absolute 3e-6 + 2^-21*difference/500.
vec3 film_sensitivity(float difference, vec3 phase) {
    vec3 turns = vec3(1.681e-3, 1.7953e-3, 2.2084e-3) * difference;
    vec3 wave = cos(6.2831853 * (turns - roundEven(turns))) * phase;
    float d2 = difference * difference;
    vec3 envelope = exp(vec3(-1.708547e-7, -3.6733088e-7, -2.6103525e-7) * d2);
    float second = 2.2399e-3 * difference;
    float red = 0.15386831 * cos(6.2831853 * (second - roundEven(second))) * phase.x * exp(-1.7876617e-7 * d2);
    vec3 seen = vec3(0.84659, 1.0002219, 1.0011225) * wave * envelope + vec3(red, 0.0, 0.0);
    return vec3(
        3.2404542 * seen.x - 1.5371385 * seen.y - 0.4985314 * seen.z,
        -0.969266 * seen.x + 1.8760108 * seen.y + 0.041556 * seen.z,
        0.0556434 * seen.x - 0.2040259 * seen.y + 1.0572252 * seen.z
    );
}

/// The reflectance of a thin film on a dielectric or a metal.
///
/// Parameters: `eta_out`, `eta_film` indices of refraction of the outside and of the film, from 1 on; `f0` linear reflectance of the material at normal incidence in air, [0, 1]; `nm` thickness of the film, nanometres, at least 0; `mu` cosine of the angle of incidence, [0, 1].
/// Returns: linear reflectance, [0, 1], in place of a Fresnel term.
/// Source: Belcour, Barla, "A Practical Extension to Microfacet Theory for the Modeling of Varying Iridescence", 2017; Khronos Group, KHR_materials_iridescence, 2022.
/// Edges: no film, and one of the outside's index, leave the material within 0.04 at normal incidence: `eta_film` fades to `eta_out` below 0.03 nm; at grazing angles Schlick's form lets such a film still reflect, at the cosine 0.3 up to 0.36 for an `f0` of 0.04; 1 where the film reflects totally; indices are clamped to [1, 10], `nm` to [0, 100000], `mu` to [0, 1], `f0` to [0, 0.9999].
/// Error model: absolute 2^-16 + 2^-20*nm*eta_film/500; near total reflection in the film also 16*2^-23/c, c the cosine within the film.
vec3 iridescence(float eta_out, float eta_film, vec3 f0, float nm, float mu) {
    float outside = clamp(eta_out, 1.0, 10.0);
    float thick = clamp(nm, 0.0, 1e5);
    float film = outside + (clamp(eta_film, 1.0, 10.0) - outside) * smoothstep(0.0, 0.03, thick);
    float c1 = clamp(mu, 0.0, 1.0);
    float sine = outside / film;
    float c2_squared = 1.0 - sine * sine * ((1.0 - c1) * (1.0 + c1));
    if (!(c2_squared > 0.0)) {
        return vec3(1.0);
    }
    float c2 = sqrt(c2_squared);
    float r12 = f_schlick(vec3(f0_from_ior(film / outside)), 1.0, c1).x;
    vec3 base = vec3(ior_from_f0(f0.x), ior_from_f0(f0.y), ior_from_f0(f0.z));
    vec3 inner = vec3(f0_from_ior(base.x / film), f0_from_ior(base.y / film), f0_from_ior(base.z / film));
    vec3 r23 = f_schlick(inner, 1.0, c2);
    // A reflection by a denser medium shifts by half a wave: one at the film's lower side, one at its upper side from within.
    vec3 from_base = mix(vec3(1.0), vec3(-1.0), lessThan(base, vec3(film)));
    vec3 phase = from_base * (film < outside ? 1.0 : -1.0);
    float difference = 2.0 * film * thick * c2;
    vec3 both = clamp(r12 * r23, vec3(1e-5), vec3(0.9999));
    float through = 1.0 - r12;
    vec3 steady = through * through * r23 / (vec3(1.0) - both);
    vec3 wave = (steady - vec3(through)) * 2.0;
    vec3 first = wave * sqrt(both) * film_sensitivity(difference, phase);
    vec3 second = wave * both * film_sensitivity(2.0 * difference, vec3(1.0));
    return clamp(vec3(r12) + steady + first + second, vec3(0.0), vec3(1.0));
}

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

#endif
