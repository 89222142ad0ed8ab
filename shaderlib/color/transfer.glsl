//! From linear light to what a screen shows: transfer functions, tone curves, fog.
//!
//! Made from `transfer.wesl` by `cargo xtask docs`: edit that, not this file.

#ifndef LAMPLIGHT_COLOR_TRANSFER_GLSL
#define LAMPLIGHT_COLOR_TRANSFER_GLSL

#include "../math/safe.glsl"

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

/// The sRGB code of one linear channel.
///
/// Parameters: `x` linear, [0, 1], and above 1, where the curve continues.
/// Returns: sRGB code, [0, 1] for inputs in [0, 1].
/// Source: IEC 61966-2-1:1999.
/// Edges: a negative input counts as 0.
/// Error model: that of `safe_pow(x, 1/2.4)` times 1.055 + 2^-24 + 2 ULP; either branch at 0.0031308, where they differ by 3e-8.
float srgb_from_linear_channel(float x) {
    float x1 = max(x, 0.0);
    return x1 > 0.0031308 ? 1.055 * exp2(0.41666667 * log2(x1)) - 0.055 : 12.92 * x1;
}

/// The linear value of one sRGB channel.
///
/// Parameters: `x` sRGB code, [0, 1], and above 1, where the curve continues.
/// Returns: linear, [0, 1] for inputs in [0, 1].
/// Source: IEC 61966-2-1:1999.
/// Edges: a negative input counts as 0.
/// Error model: that of `safe_pow((x + 0.055)/1.055, 2.4)` + 7 ULP; either branch at 0.04045, where they differ by 1e-8.
float linear_from_srgb_channel(float x) {
    float x1 = max(x, 0.0);
    return x1 > 0.04045 ? exp2(2.4 * log2((x1 + 0.055) / 1.055)) : x1 / 12.92;
}

/// The sRGB code of a linear colour.
///
/// Parameters: `c` linear colour, [0, 1], and above 1, where the curve continues.
/// Returns: sRGB colour, [0, 1] for inputs in [0, 1].
/// Source: IEC 61966-2-1:1999.
/// Edges: a negative channel counts as 0.
/// Error model: that of `srgb_from_linear_channel`.
vec3 srgb_from_linear(vec3 c) {
    return vec3(srgb_from_linear_channel(c.x), srgb_from_linear_channel(c.y), srgb_from_linear_channel(c.z));
}

/// The linear value of an sRGB colour.
///
/// Parameters: `c` sRGB colour, [0, 1], and above 1, where the curve continues.
/// Returns: linear colour, [0, 1] for inputs in [0, 1].
/// Source: IEC 61966-2-1:1999.
/// Edges: a negative channel counts as 0.
/// Error model: that of `linear_from_srgb_channel`.
vec3 linear_from_srgb(vec3 c) {
    return vec3(linear_from_srgb_channel(c.x), linear_from_srgb_channel(c.y), linear_from_srgb_channel(c.z));
}

/// Reinhard's tone curve, per channel.
///
/// Parameters: `c` linear colour, at least 0.
/// Returns: `c/(1 + c)`, linear, [0, 1).
/// Source: Reinhard, Stark, Shirley, Ferwerda, "Photographic Tone Reproduction for Digital Images", 2002, equation 3.
/// Edges: a negative channel counts as 0; 1 from about 2^24 on.
/// Error model: 3.5 ULP.
vec3 tonemap_reinhard(vec3 c) {
    vec3 x = max(c, vec3(0.0));
    return x / (1.0 + x);
}

/// A fit to the filmic tone curve of ACES, per channel.
///
/// Parameters: `c` linear colour, at least 0, multiplied by 0.6 before for the original exposure of ACES.
/// Returns: `(c*(2.51*c + 0.03))/(c*(2.43*c + 0.59) + 0.14)`, linear, clamped to [0, 1].
/// Source: Narkowicz, "ACES Filmic Tone Mapping Curve", 2016.
/// Edges: a negative channel counts as 0; above 65504 the input counts as that, where the curve is 1.
/// Error model: 6 ULP.
vec3 tonemap_aces(vec3 c) {
    vec3 x = clamp(c, vec3(0.0), vec3(65504.0));
    vec3 y = x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
    return clamp(y, vec3(0.0), vec3(1.0));
}

/// The clear share of a view through fog that thickens evenly between two distances.
///
/// Parameters: `d` distance to the viewer, scene units; `start`, `end` distances where fog begins and hides all, scene units.
/// Returns: `clamp((end - d)/(end - start), 0, 1)`: 1 is clear, 0 all fog: mix(fog, colour, share).
/// Source: OpenGL 2.1 specification, section 3.10 "Fog", linear.
/// Edges: 1 for a `d` before both `start` and `end`, so for negative ones; a hard edge at `end`, itself all fog, where `end` is not beyond `start`.
/// Error model: absolute 2^-23*(|end| + |d|)/(end - start) + 3*2^-23.
float fog_linear(float d, float start, float end) {
    return clamp((end - d) / max(end - start, 1e-30), 0.0, 1.0);
}

/// The clear share of a view through fog of even density.
///
/// Parameters: `d` distance to the viewer, scene units, at least 0; `density` 1/scene units, at least 0.
/// Returns: `exp(-density*d)`, [0, 1]: 1 is clear, 0 all fog.
/// Source: OpenGL 2.1 specification, section 3.10 "Fog", exponential.
/// Edges: 1 where the product of `d` and `density` is 0 or below; two negative ones count as their magnitudes.
/// Error model: relative (3 + 2*x)*2^-23 + x*2^-24, with x = density*d.
float fog_exp(float d, float density) {
    return exp(-max(density * d, 0.0));
}

/// The clear share of a view through fog that is thin nearby.
///
/// Parameters: `d` distance to the viewer, scene units, at least 0; `density` 1/scene units, at least 0.
/// Returns: `exp(-(density*d)^2)`, [0, 1]: 1 is clear, 0 all fog.
/// Source: OpenGL 2.1 specification, section 3.10 "Fog", exponential squared.
/// Edges: 1 where `d` or `density` is 0; both count as their magnitudes.
/// Error model: relative (3 + 2*x)*2^-23 + 3*x*2^-24, with x = (density*d)^2.
float fog_exp2(float d, float density) {
    float x = density * d;
    return exp(-x * x);
}

/// A luminance as the perceptual quantiser codes it.
///
/// Parameters: `nits` luminance of the display, candelas per square metre, [0, 10000].
/// Returns: code value, [0, 1]; 0.508 for 100.
/// Source: SMPTE ST 2084:2014, equation 5.2; ITU-R BT.2100-2, table 4.
/// Edges: luminances outside [0, 10000] are clamped to it; black is 7e-7.
/// Error model: absolute 2^-15: the outer power has the exponent 78.8.
float pq_from_nits(float nits) {
    float y = safe_pow(min(nits, 10000.0) * 1e-4, 0.15930176);
    // The quotient is 1 but for the last bits near white, so it is 1 less a rest.
    float rest = 0.1640625 * (1.0 - y) / (1.0 + 18.6875 * y);
    return exp2(78.84375 * log2(1.0 - rest));
}

/// The luminance that a code value of the perceptual quantiser stands for.
///
/// Parameters: `code` value, [0, 1].
/// Returns: luminance of the display, candelas per square metre, [0, 10000].
/// Source: SMPTE ST 2084:2014, equation 4.1; ITU-R BT.2100-2, table 4.
/// Edges: codes outside [0, 1] are clamped; 0 up to the code of black.
/// Error model: relative 2^-11 + 2^-22*10000/nits, absolute 1e-6.
float nits_from_pq(float code) {
    float x = safe_pow(min(code, 1.0), 0.012683313);
    float y = (x - 0.8359375) / (18.851562 - 18.6875 * x);
    return 10000.0 * safe_pow(y, 6.277395);
}

/// Linear light of the scene as hybrid log-gamma codes it.
///
/// Parameters: `e` linear light, [0, 1].
/// Returns: code value, [0, 1]: a square root up to 0.5, a logarithm above.
/// Source: ITU-R BT.2100-2, table 5, for light in [0, 1]; some texts have it in [0, 12].
/// Edges: light outside [0, 1] is clamped.
/// Error model: absolute 2^-20.
float hlg_from_linear(float e) {
    float x = clamp(e, 0.0, 1.0);
    if (x <= 0.083333336) {
        return sqrt(3.0 * x);
    }
    return 0.17883277 * log(12.0 * x - 0.28466892) + 0.55991073;
}

/// Linear light of the scene from a code value of hybrid log-gamma.
///
/// Parameters: `code` value, [0, 1].
/// Returns: linear light, [0, 1].
/// Source: ITU-R BT.2100-2, table 5: the inverse of the transfer function.
/// Edges: codes outside [0, 1] are clamped.
/// Error model: absolute 2^-19.
float linear_from_hlg(float code) {
    float x = clamp(code, 0.0, 1.0);
    return x <= 0.5 ? x * x / 3.0 : (exp((x - 0.55991073) / 0.17883277) + 0.28466892) / 12.0;
}

/// A colour with noise that rounding turns into the right mean: without it, smooth gradients have bands.
///
/// Parameters: `c` colour as the display codes it, [0, 1]; `noise` a number in [0, 1), another for each pixel; `steps` how many steps the display has from 0 to 1: 255 for eight bits.
/// Returns: `c + (noise - 1/2)/steps`, clamped to [0, 1]; where it is not clamped, the mean of what it is rounded to is `c`.
/// Source: Roberts, "Picture Coding Using Pseudo-Random Noise", 1962: noise of one step, evenly distributed.
/// Edges: `steps` below 1 count as 1; `c` and `noise` are not clamped, but the result is.
/// Error model: absolute 3*2^-24.
vec3 dither(vec3 c, float noise, float steps) {
    return clamp(c + (noise - 0.5) / max(steps, 1.0), vec3(0.0), vec3(1.0));
}

/// A colour as intensity and two differences, which hold hue and saturation apart from brightness.
///
/// Parameters: `c` linear colour, Rec. 2020, candelas per square metre, [0, 10000].
/// Returns: `(I, Ct, Cp)`: the intensity is in [0, 1], 0.508 for 100, and both differences are 0 for greys, and within [-0.9, 0.9].
/// Source: ITU-R BT.2100-2, table 7, for the perceptual quantiser.
/// Edges: as for `pq_from_nits`, of the mixtures of the channels.
/// Error model: absolute 2^-12, from `pq_from_nits`.
vec3 ictcp_from_nits(vec3 c) {
    vec3 lms = mat3(
        vec3(0.41210938, 0.16674805, 0.024169922),
        vec3(0.52392578, 0.72045898, 0.075439453),
        vec3(0.063964844, 0.11279297, 0.90039062)
    ) * c;
    float l = pq_from_nits(lms.x);
    float m = pq_from_nits(lms.y);
    float s = pq_from_nits(lms.z);
    return vec3(0.5 * (l + m), 1.6137695 * l - 3.3234863 * m + 1.7097168 * s, 4.3781738 * l - 4.2456055 * m - 0.13256836 * s);
}

/// The linear colour from intensity and two differences.
///
/// Parameters: `c` `(I, Ct, Cp)` as from `ictcp_from_nits`.
/// Returns: linear colour, Rec. 2020, candelas per square metre, at least 0.
/// Source: ITU-R BT.2100-2, table 7, backwards.
/// Edges: as for `nits_from_pq`; channels below 0, outside Rec. 2020, are 0.
/// Error model: absolute 2^-8 of the largest response of the eye, from `nits_from_pq`.
vec3 nits_from_ictcp(vec3 c) {
    float l = nits_from_pq(c.x + 0.008609037 * c.y + 0.11102963 * c.z);
    float m = nits_from_pq(c.x - 0.008609037 * c.y - 0.11102963 * c.z);
    float s = nits_from_pq(c.x + 0.56003134 * c.y - 0.32062717 * c.z);
    vec3 rgb = mat3(
        vec3(3.4366067, -0.79132956, -0.0259499),
        vec3(-2.5064521, 1.9836005, -0.098913715),
        vec3(0.069845424, -0.1922709, 1.1248636)
    ) * vec3(l, m, s);
    return max(rgb, vec3(0.0));
}

/// `fog_linear` with its division done on the host.
///
/// Parameters: `d` distance to the viewer, scene units; `scale` factor of the distance, `-1/(end - start)`, 1/scene units; `offset` what is added, `end/(end - start)`.
/// Returns: `clamp(d*scale + offset, 0, 1)`: 1 is clear, 0 all fog.
/// Source: as `fog_linear`.
/// Edges: the result is clamped to [0, 1], whatever `d`, `scale` and `offset` are.
/// Error model: absolute 2^-23*(|d*scale| + |offset|).
float fog_scale_offset(float d, float scale, float offset) {
    return clamp(d * scale + offset, 0.0, 1.0);
}

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

#endif
