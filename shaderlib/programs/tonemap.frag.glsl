#version 450
//! The fragment stage of `tonemap`, which `tonemap.wesl` describes.
//!
//! Made from `tonemap.wesl` by `cargo xtask docs`: edit that, not this file.

#include "../color/tonemap.glsl"
#include "../color/transfer.glsl"
#if EXPOSURE == EXPOSURE_EV100
#include "../lighting/units.glsl"
#endif
#if DITHER
#include "../math/noise.glsl"
#endif

layout(location = 0) in vec2 in_uv;

layout(location = 0) out vec4 out_color;

layout(set = 0, binding = 0) uniform texture2D light;
layout(set = 0, binding = 1) uniform sampler light_sampler;

#if EXPOSURE != EXPOSURE_NONE || CURVE == CURVE_REINHARD_EXTENDED || TRANSFER == TRANSFER_PQ || DITHER
/// The camera that took the light, and the display that shows it. The layout of the first four is the same in every permutation.
layout(std140, set = 0, binding = 2) uniform Display {
    /// `exposure=factor`: multiplied with the light.
    float factor;
    /// `exposure=ev100`: exposure value at ISO 100, for light in candelas per square metre.
    float ev100;
    /// `curve=reinhard_extended`: the least light that is white, after the exposure.
    float white;
    /// `transfer=pq`: luminance of white, candelas per square metre.
    float nits;
#if DITHER
    /// Steps of the target from 0 to 1: 255 for eight bits.
    float steps;
    /// Number of the frame, so that the noise of frames differs.
    uint frame;
#endif
} display;
#endif

/// The light as the camera records it.
vec3 exposed(vec3 color) {
#if EXPOSURE == EXPOSURE_NONE
    return color;
#elif EXPOSURE == EXPOSURE_FACTOR
    return color * display.factor;
#elif EXPOSURE == EXPOSURE_EV100
    return color * exposure(display.ev100);
#endif
}

/// What the display should show: linear, [0, 1] for every curve.
vec3 toned(vec3 color) {
#if CURVE == CURVE_NONE
    return color;
#elif CURVE == CURVE_REINHARD
    return tonemap_reinhard(color);
#elif CURVE == CURVE_REINHARD_EXTENDED
    return reinhard_extended(color, display.white);
#elif CURVE == CURVE_ACES
    return tonemap_aces(color);
#elif CURVE == CURVE_ACES_HILL
    return aces_hill(color);
#elif CURVE == CURVE_AGX
    return agx(color);
#elif CURVE == CURVE_AGX_BLENDER
    return agx_blender(color);
#elif CURVE == CURVE_GT7
    return gt7(color);
#elif CURVE == CURVE_HABLE
    return hable(color);
#elif CURVE == CURVE_NEUTRAL
    return neutral(color);
#elif CURVE == CURVE_UCHIMURA
    return uchimura(color);
#endif
}

/// The colour as the display wants it.
vec3 coded(vec3 color) {
#if TRANSFER == TRANSFER_LINEAR
    return color;
#elif TRANSFER == TRANSFER_SRGB
    return srgb_from_linear(color);
#elif TRANSFER == TRANSFER_PQ
    vec3 nits = color * display.nits;
    return vec3(pq_from_nits(nits.x), pq_from_nits(nits.y), pq_from_nits(nits.z));
#elif TRANSFER == TRANSFER_HLG
    return vec3(hlg_from_linear(color.x), hlg_from_linear(color.y), hlg_from_linear(color.z));
#endif
}

void main() {
    vec4 texel = textureLod(sampler2D(light, light_sampler), in_uv, 0.0);
    vec3 color = coded(toned(exposed(texel.rgb)));
#if DITHER
    out_color = vec4(dither(color, ign_time(gl_FragCoord.xy, display.frame), display.steps), texel.a);
#else
    out_color = vec4(color, texel.a);
#endif
}
