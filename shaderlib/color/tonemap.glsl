//! Tone curves: what a display of limited range shows of linear light.
//!
//! All take and give linear Rec. 709 colours; the transfer function of the display comes after them.
//!
//! Made from `tonemap.wesl` by `cargo xtask docs`: edit that, not this file.

#ifndef LAMPLIGHT_COLOR_TONEMAP_GLSL
#define LAMPLIGHT_COLOR_TONEMAP_GLSL

#include "../math/safe.glsl"
#include "transfer.glsl"

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

/// The tone curve of AgX: a line through middle grey with a toe and a shoulder.
///
/// Parameters: `x` binary logarithm of the light, scaled so that 16.5 stops fill [0, 1] and middle grey is at 20/33.
/// Returns: from 0 to 1 but for rounding: 0.5 for middle grey, where its slope is 2.
/// Source: Sobotka, AgX, 2022: sigmoids of the powers 3 and 3.25 that reach the corners. This is the closed form; common polynomial fits of it are off by 0.006 and 0.018.
/// Edges: `x` outside [0, 1] is clamped.
/// Error model: absolute 2^-19.
float agx_curve(float x) {
    float d = clamp(x, 0.0, 1.0) - 0.60606061;
    // The distance over the scale that takes each branch to its corner.
    if (d < 0.0) {
        float u = -3.9041349 * d;
        return 0.5 - 0.51227738 * u / pow(1.0 + u * u * u, 0.33333333);
    }
    float w = 3.6936886 * d;
    return 0.5 + 0.54146416 * w / pow(1.0 + safe_pow(w, 3.25), 0.30769231);
}

/// The AgX view transform: the contrast of film, and colours that fade to white as they become brighter.
///
/// Parameters: `c` linear colour, Rec. 709, at least 0, with middle grey at 0.18.
/// Returns: linear colour, Rec. 709, [0, 1].
/// Source: Sobotka, AgX, 2022, with the matrices of Blender 4 over Rec. 2020 as three.js and Filament carry them, and the curve in closed form.
/// Edges: channels below 0 count as 0; light is black 10 stops below the middle grey of 0.18, and white 6.5 stops above it.
/// Error model: absolute 2^-16.
vec3 agx(vec3 c) {
    vec3 wide = mat3(
        vec3(0.6274039, 0.069097288, 0.016391439),
        vec3(0.32928303, 0.9195404, 0.08801331),
        vec3(0.043313067, 0.011362316, 0.89559525)
    ) * max(c, vec3(0.0));
    vec3 inset = mat3(
        vec3(0.85662715, 0.13731897, 0.11189821),
        vec3(0.09512124, 0.76124199, 0.0767994),
        vec3(0.048251606, 0.10143904, 0.81130237)
    ) * wide;
    vec3 stops = (log2(max(inset, vec3(1e-10))) + 12.47393) / 16.499999;
    vec3 toned = vec3(agx_curve(stops.x), agx_curve(stops.y), agx_curve(stops.z));
    vec3 outset = mat3(
        vec3(1.1271006, -0.14132976, -0.14132976),
        vec3(-0.11060664, 1.1578237, -0.11060664),
        vec3(-0.01649394, -0.01649394, 1.2519364)
    ) * toned;
    vec3 shown = vec3(safe_pow(outset.x, 2.2), safe_pow(outset.y, 2.2), safe_pow(outset.z, 2.2));
    vec3 narrow = mat3(
        vec3(1.660491, -0.12455047, -0.018150763),
        vec3(-0.58764114, 1.1328999, -0.1005789),
        vec3(-0.072849864, -0.0083494221, 1.1187297)
    ) * shown;
    return clamp(narrow, vec3(0.0), vec3(1.0));
}

/// The tone curve that leaves the colours of products alone: it bends highlights only.
///
/// Parameters: `c` linear colour, at least 0.
/// Returns: linear colour, from 0 to 1 but for rounding.
/// Source: Khronos Group, PBR Neutral Tone Mapper, 2024.
/// Edges: channels below 0 count as 0, above 1e10 as that.
/// Error model: absolute 2^-20.
vec3 neutral(vec3 c) {
    vec3 positive = clamp(c, vec3(0.0), vec3(1e10));
    float least = min(min(positive.x, positive.y), positive.z);
    // What a dielectric reflects at normal incidence is taken away.
    float offset = least < 0.08 ? least - 6.25 * least * least : 0.04;
    vec3 base = positive - offset;
    float peak = max(max(base.x, base.y), base.z);
    if (!(peak >= 0.76)) {
        return base;
    }
    float bent = 1.0 - 0.0576 / (peak - 0.52);
    float white = 1.0 - 1.0 / (0.15 * (peak - bent) + 1.0);
    return mix(base * (bent / peak), vec3(bent), white);
}

/// The light that `neutral` shows as a colour.
///
/// Parameters: `c` linear colour, [0, 1].
/// Returns: linear colour, at least 0.
/// Source: Khronos Group, PBR Neutral Tone Mapper, 2024, its inverse.
/// Edges: channels are clamped to [0, 1]; the largest counts as at most 0.9999, for which the light is 576.
/// Error model: relative 2^-18/(1 - m)^2, with m the largest channel, above 0.76; absolute 2^-12 near black.
vec3 neutral_inverse(vec3 c) {
    vec3 base = clamp(c, vec3(0.0), vec3(0.9999));
    float peak = max(max(base.x, base.y), base.z);
    if (peak > 0.76) {
        float old = 0.0576 / (1.0 - peak) + 0.52;
        float less = 0.15 * (old - peak) + 1.0;
        // Undoes the mix with white, then the bend.
        base = max((base + (1.0 / less - 1.0) * peak) * less, vec3(0.0)) * (old / peak);
    }
    float least = min(min(base.x, base.y), base.z);
    float offset = least < 0.04 ? sqrt(least * 0.16) - least : 0.04;
    return base + offset;
}

/// A fit to the ACES reference rendering and output transforms, with their colour matrices.
///
/// Parameters: `c` linear colour, Rec. 709, at least 0, often divided by 0.6 before to match the exposure of other curves.
/// Returns: linear colour, Rec. 709, [0, 1].
/// Source: Hill, "BakingLab", 2016: the reference rendering and output transforms fitted between two matrices.
/// Edges: channels below 0 count as 0, above 1e6 as that; black, which the fit makes -0.0004, is 0.
/// Error model: absolute 2^-20.
vec3 aces_hill(vec3 c) {
    vec3 v = mat3(
        vec3(0.59719, 0.076, 0.0284),
        vec3(0.35458, 0.90834, 0.13383),
        vec3(0.04823, 0.01566, 0.83777)
    ) * clamp(c, vec3(0.0), vec3(1e6));
    vec3 fitted = (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.432951) + 0.238081);
    vec3 shown = mat3(
        vec3(1.60475, -0.10208, -0.00327),
        vec3(-0.53108, 1.10813, -0.07276),
        vec3(-0.07367, -0.00605, 1.07602)
    ) * fitted;
    return clamp(shown, vec3(0.0), vec3(1.0));
}

/// One channel of a filmic curve with a toe and a shoulder, before it is scaled to white.
///
/// Parameters: `x` linear light, at least 0.
/// Returns: a number that rises from 0 towards 0.93.
/// Source: Hable, "Uncharted 2: HDR Lighting", Game Developers Conference, 2010.
/// Edges: light below 0 counts as 0, above 1e6 as that.
/// Error model: absolute 2^-22.
float hable_channel(float x) {
    float v = clamp(x, 0.0, 1e6);
    // The published difference of two quotients over one denominator, so that black is exactly 0.
    return v * (0.14 * v + 0.016666667) / (v * (0.15 * v + 0.5) + 0.06);
}

/// A filmic curve with a toe and a shoulder, by channel.
///
/// Parameters: `c` linear colour, at least 0.
/// Returns: linear colour, [0, 1]: white for light of 5.6.
/// Source: Hable, "Uncharted 2: HDR Lighting", Game Developers Conference, 2010: exposure 2, white 11.2.
/// Edges: channels below 0 count as 0.
/// Error model: absolute 2^-21.
vec3 hable(vec3 c) {
    vec3 curve = vec3(hable_channel(2.0 * c.x), hable_channel(2.0 * c.y), hable_channel(2.0 * c.z));
    return clamp(curve * 1.3790642, vec3(0.0), vec3(1.0));
}

/// Reinhard's curve with a light that is shown as white.
///
/// Parameters: `c` linear colour, at least 0; `white` least light that is white, above 0.
/// Returns: `c*(1 + c/white^2)/(1 + c)`, by channel, linear, from 0 to 1 but for rounding.
/// Source: Reinhard, Stark, Shirley, Ferwerda, "Photographic Tone Reproduction for Digital Images", 2002, equation 4.
/// Edges: channels of `c` below 0 count as 0; a `white` below 0.001 counts as that.
/// Error model: 5 ULP.
vec3 reinhard_extended(vec3 c, float white) {
    float least = max(white, 0.001);
    vec3 x = clamp(c, vec3(0.0), vec3(least));
    return x * (1.0 + x / (least * least)) / (1.0 + x);
}

/// A curve of a toe, a line and a shoulder, one channel.
///
/// Parameters: `x` linear light, at least 0.
/// Returns: a number in [0, 1]: a toe below `x` = 0.22, a line of slope 1 up to `x` = 0.532, a shoulder above.
/// Source: Uchimura, "HDR Theory and Practice", CEDEC, 2017: P 1, a 1, m 0.22, l 0.4, c 1.33, b 0.
/// Edges: light below 0 counts as 0.
/// Error model: absolute 2^-20.
float uchimura_channel(float x) {
    float toe = 0.22 * safe_pow(x / 0.22, 1.33);
    float shoulder = 1.0 - 0.468 * exp(-2.1367521 * (x - 0.532));
    float from_toe = smoothstep(0.0, 0.22, x);
    return x >= 0.532 ? shoulder : mix(toe, x, from_toe);
}

/// A curve of a toe, a line and a shoulder.
///
/// Parameters: `c` linear colour, at least 0.
/// Returns: linear colour, [0, 1].
/// Source: Uchimura, "HDR Theory and Practice", CEDEC, 2017, by channel.
/// Edges: channels below 0 count as 0.
/// Error model: absolute 2^-20.
vec3 uchimura(vec3 c) {
    return vec3(uchimura_channel(c.x), uchimura_channel(c.y), uchimura_channel(c.z));
}

/// The tone curve of AgX as Blender has it: a line through middle grey with a softer toe and shoulder.
///
/// Parameters: `x` binary logarithm of the light, scaled so that 16.5 stops fill [0, 1] and middle grey is at 20/33.
/// Returns: from 0 to 1 but for rounding, to be raised to the power 2.4: `0.18^(1/2.4)` for middle grey, where its slope is 2.4.
/// Source: Chow, the AgX of Blender 4, 2023: sigmoids of the power 1.5 that reach the corners, in closed form.
/// Edges: `x` outside [0, 1] is clamped.
/// Error model: absolute 2^-19.
float agx_curve_blender(float x) {
    float d = clamp(x, 0.0, 1.0) - 0.60606061;
    if (d < 0.0) {
        float u = -4.2427143 * d;
        return 0.48943709 - 0.56567561 * u / pow(1.0 + u * sqrt(u), 0.66666667);
    }
    float w = 3.3557127 * d;
    return 0.48943709 + 0.71519829 * w / pow(1.0 + w * sqrt(w), 0.66666667);
}

/// The AgX view transform of Blender: less contrast than `agx`, and hues that turn less as they become brighter.
///
/// Parameters: `c` linear colour, Rec. 709, at least 0, with middle grey at 0.18, which stays there.
/// Returns: linear colour, Rec. 709, [0, 1].
/// Source: Chow, the AgX of Blender 4, 2023, with its matrices over Rec. 2020; of the hue's turn by the curve, 40 % are kept. Colours that leave Rec. 709 are clamped instead of being compensated for luminance.
/// Edges: as `agx`.
/// Error model: absolute 2^-16.
vec3 agx_blender(vec3 c) {
    vec3 inset = mat3(
        vec3(0.54481475, 0.14041695, 0.08881042),
        vec3(0.3737874, 0.75413755, 0.17887176),
        vec3(0.081397855, 0.1054455, 0.73231782)
    ) * max(c, vec3(0.0));
    vec3 stops = (log2(max(inset, vec3(1e-10))) + 12.47393) / 16.499999;
    vec3 toned = vec3(agx_curve_blender(stops.x), agx_curve_blender(stops.y), agx_curve_blender(stops.z));
    vec3 shown = vec3(safe_pow(toned.x, 2.4), safe_pow(toned.y, 2.4), safe_pow(toned.z, 2.4));
    // The curve keeps the order of channels, so their place between the least and the largest is the hue.
    float least = min(min(inset.x, inset.y), inset.z);
    float span = max(max(max(inset.x, inset.y), inset.z) - least, 1e-30);
    float dark = min(min(shown.x, shown.y), shown.z);
    float bright = max(max(shown.x, shown.y), shown.z);
    vec3 hue = dark + (bright - dark) * ((inset - least) / span);
    vec3 narrow = mat3(
        vec3(1.9648874, -0.29931336, -0.16435274),
        vec3(-0.8559885, 1.326398, -0.23818397),
        vec3(-0.10889892, -0.0270846, 1.4025367)
    ) * (0.6 * hue + 0.4 * shown);
    return clamp(narrow, vec3(0.0), vec3(1.0));
}

/// The tone curve of Gran Turismo 7 for a white of 250 candelas per square metre, one channel.
///
/// Parameters: `x` linear light, at least 0: 1 is 100 candelas per square metre.
/// Returns: a number from 0 to 2.96, of which a display shows up to 2.5: a toe below 0.538, a line up to 1.11, a shoulder above.
/// Source: Polyphony Digital, "Driving Toward Reality: Physically Based Tone Mapping and Perceptual Fidelity in Gran Turismo 7", SIGGRAPH, 2025, with its example code: alpha 0.25, grey 0.538, line up to 0.444 of the white, toe 1.28.
/// Edges: light below 0 counts as 0.
/// Error model: absolute 2^-19.
float gt7_curve(float x) {
    float toe = 0.538 * safe_pow(x / 0.538, 1.28);
    float shoulder = 2.9633333 - 3.3733512 * exp(-0.53956835 * x);
    return x >= 1.11 ? shoulder : mix(toe, x, smoothstep(0.0, 0.538, x));
}

/// The tone mapping of Gran Turismo 7: a curve by channel, mixed with one of intensity that keeps hues.
///
/// Parameters: `c` linear colour, Rec. 709, at least 0: 1 is 100 candelas per square metre.
/// Returns: linear colour, Rec. 709, [0, 1]: 1 is 250 candelas per square metre.
/// Source: Polyphony Digital, "Driving Toward Reality: Physically Based Tone Mapping and Perceptual Fidelity in Gran Turismo 7", SIGGRAPH, 2025, with its example code for displays of the usual range, which computes in Rec. 2020: 60 % by intensity, whose colours fade from 0.98 to 1.16 of the white's.
/// Edges: channels below 0 count as 0, above 1e6 as that.
/// Error model: absolute 2^-11, from the perceptual quantiser and back.
vec3 gt7(vec3 c) {
    vec3 wide = mat3(
        vec3(0.6274039, 0.069097288, 0.016391439),
        vec3(0.32928303, 0.9195404, 0.08801331),
        vec3(0.043313067, 0.011362316, 0.89559525)
    ) * clamp(c, vec3(0.0), vec3(1e6));
    vec3 curved = vec3(gt7_curve(wide.x), gt7_curve(wide.y), gt7_curve(wide.z));
    vec3 before = ictcp_from_nits(100.0 * wide);
    vec3 after = ictcp_from_nits(100.0 * curved);
    // Bright colours fade to white. 0.6026 is the intensity of white.
    float kept = 1.0 - smoothstep(0.98, 1.16, before.x * 1.6595881);
    vec3 even = nits_from_ictcp(vec3(after.x, before.yz * kept)) * 0.01;
    vec3 shown = min(0.4 * curved + 0.6 * even, vec3(2.5)) * 0.4;
    vec3 narrow = mat3(
        vec3(1.660491, -0.12455047, -0.018150763),
        vec3(-0.58764114, 1.1328999, -0.1005789),
        vec3(-0.072849864, -0.0083494221, 1.1187297)
    ) * shown;
    return clamp(narrow, vec3(0.0), vec3(1.0));
}

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

#endif
