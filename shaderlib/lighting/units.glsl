//! Photometric units: from the numbers on a lamp and on a camera to those of a shader.
//!
//! The colour of a lamp of the programs, `Light.color`, is an intensity over pi: with it, a white matt
//! surface has the luminance that is its colour. So divide candelas and lux by pi, once.
//!
//! Made from `units.wesl` by `cargo xtask docs`: edit that, not this file.

#ifndef LAMPLIGHT_LIGHTING_UNITS_GLSL
#define LAMPLIGHT_LIGHTING_UNITS_GLSL

#include "../math/safe.glsl"

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

/// The luminous intensity of a point light of a luminous power.
///
/// Parameters: `lm` luminous power, lumens, at least 0.
/// Returns: `lm/(4*pi)`, candelas: over a distance squared it is illuminance.
/// Source: Lagarde, de Rousiers, "Moving Frostbite to Physically Based Rendering", 2014, section 4.5.
/// Edges: 0 for no power; a negative one is not clamped.
/// Error model: 1.5 ULP.
float intensity_point(float lm) {
    return lm * 0.07957747;
}

/// The luminous intensity of a spot light of a luminous power that all goes into its cone.
///
/// Parameters: `lm` luminous power, lumens, at least 0; `cos_outer` cosine of the cone's half angle, [-1, 1].
/// Returns: `lm/(2*pi*(1 - cos_outer))`, candelas.
/// Source: Lagarde, de Rousiers, "Moving Frostbite to Physically Based Rendering", 2014, section 4.5; the solid angle of a cone.
/// Edges: 0 for an `lm` of 0, and a negative one is not clamped; that of a point light for a `cos_outer` of -1 or less; `1 - cos_outer` counts as at least 1e-6, a tenth of a degree.
/// Error model: 3.5 ULP.
float intensity_spot(float lm, float cos_outer) {
    return lm * 0.15915494 / clamp(1.0 - cos_outer, 1e-6, 2.0);
}

/// The luminous intensity of a spot light whose brightness does not change with its cone.
///
/// Parameters: `lm` luminous power, lumens, at least 0: the power that a cone with a half angle of 60 degrees, and so a solid angle of pi, would emit.
/// Returns: `lm/pi`, candelas.
/// Source: Guy, Agopian, "Physically Based Rendering in Filament", 2018, section 5.2.2.2 "Spot lights": the spot light with a light absorber.
/// Edges: 0 for no power; a negative one is not clamped.
/// Error model: 1.5 ULP.
float intensity_spot_filament(float lm) {
    return lm * 0.31830987;
}

/// The luminance of a light with an area that shines evenly into the half space before it.
///
/// Parameters: `lm` luminous power, lumens, [0, 1e20]; `area` of the surface that shines, square metres, above 0.
/// Returns: `lm/(pi*area)`, candelas per square metre.
/// Source: Lagarde, de Rousiers, "Moving Frostbite to Physically Based Rendering", 2014, section 4.7.1.
/// Edges: 0 for an `lm` of 0, and a negative one is not clamped; an `area` below a square micrometre, 1e-12, counts as that.
/// Error model: 3 ULP.
float luminance_area(float lm, float area) {
    return lm * 0.31830987 / max(area, 1e-12);
}

/// The exposure value of a camera's settings at a sensitivity of ISO 100.
///
/// Parameters: `aperture` f-number, above 0; `shutter` exposure time, seconds, above 0; `iso` sensitivity, above 0.
/// Returns: `log2(100*aperture^2/(shutter*iso))`, stops.
/// Source: ISO 2720:1974; Lagarde, de Rousiers, "Moving Frostbite to Physically Based Rendering", 2014, section 5.1.1.
/// Edges: each parameter counts as at least 1e-6.
/// Error model: absolute 2^-21 + 2^-22*|result|.
float ev100(float aperture, float shutter, float iso) {
    float n = max(aperture, 1e-6);
    return log2(n * n * 100.0 / (max(shutter, 1e-6) * max(iso, 1e-6)));
}

/// The exposure value at which a mean luminance is rendered as a middle grey.
///
/// Parameters: `luminance` mean of the scene, candelas per square metre, above 0.
/// Returns: `log2(8*luminance)`, stops.
/// Source: ISO 2720:1974 with a meter's constant K of 12.5; Lagarde, de Rousiers, "Moving Frostbite to Physically Based Rendering", 2014, section 5.1.2.
/// Edges: -126 for no light, and for a negative luminance.
/// Error model: absolute 2^-21 + 2^-22*|result|.
float ev100_from_luminance(float luminance) {
    return log2(max(8.0 * luminance, SMALLEST_NORMAL));
}

/// The exposure value for the illuminance of an incident light meter.
///
/// Parameters: `illuminance` on the scene, lux, above 0.
/// Returns: `log2(illuminance/2.5)`, stops.
/// Source: ISO 2720:1974 with a meter's constant C of 250; Lagarde, de Rousiers, "Moving Frostbite to Physically Based Rendering", 2014, section 5.1.2.
/// Edges: -126 for no light, and for a negative illuminance.
/// Error model: absolute 2^-21 + 2^-22*|result|.
float ev100_from_illuminance(float illuminance) {
    return log2(max(0.4 * illuminance, SMALLEST_NORMAL));
}

/// What luminances are multiplied by to be linear colours of a picture.
///
/// Parameters: `ev` exposure value at ISO 100, stops.
/// Returns: `1/(1.2*2^ev)`, square metres per candela: the largest luminance that the sensor holds becomes 1.
/// Source: ISO 12232:2006, saturation-based speed, with a lens of transmittance 0.65: 78/(100*0.65) = 1.2; Lagarde, de Rousiers, "Moving Frostbite to Physically Based Rendering", 2014, section 5.1.2.
/// Edges: `ev` is clamped to [-120, 120].
/// Error model: relative 2^-21 + 2^-23*|ev|.
float exposure(float ev) {
    return exp2(-clamp(ev, -120.0, 120.0)) / 1.2;
}

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

#endif
