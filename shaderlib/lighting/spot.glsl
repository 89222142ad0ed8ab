//! The cone of a spot light: a factor from the cosine `c = dot(-l, axis)` between the ray and the axis.
//!
//! Made from `spot.wesl` by `cargo xtask docs`: edit that, not this file.

#ifndef LAMPLIGHT_LIGHTING_SPOT_GLSL
#define LAMPLIGHT_LIGHTING_SPOT_GLSL

#include "../math/safe.glsl"

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

/// 1 inside the cone and on its edge, 0 outside.
///
/// Parameters: `c` cosine of the angle to the axis, [-1, 1]; `cutoff` cosine of the cone's half angle, [-1, 1].
/// Returns: 0 or 1.
/// Source: Kessenich, Sellers, Shreiner, OpenGL Programming Guide, 9th edition, 2016, example 7.5: dark where `c < cutoff`.
/// Edges: the edge itself is lit; a `c` or a `cutoff` outside [-1, 1] is compared as it is.
/// Error model: exact; either value where `c` and `cutoff` are closer than their errors.
float cone_hard(float c, float cutoff) {
    return c >= cutoff ? 1.0 : 0.0;
}

/// 1 inside the cone, 0 on its edge and outside.
///
/// Parameters: `c` cosine of the angle to the axis, [-1, 1]; `cutoff` cosine of the cone's half angle, [-1, 1].
/// Returns: 0 or 1.
/// Source: Movania et al., OpenGL: Build High Performance Graphics, 2017, chapter 4, spot light; Igalia, "Working with lights and shadows", part I.
/// Edges: the edge itself is dark, the one difference from `cone_hard`; a `c` or a `cutoff` outside [-1, 1] is compared as it is.
/// Error model: exact; either value where `c` and `cutoff` are closer than their errors.
float cone_hard_exclusive(float c, float cutoff) {
    return c > cutoff ? 1.0 : 0.0;
}

/// A power of the cosine inside the cone, 0 outside.
///
/// Parameters: `c` cosine of the angle to the axis, [-1, 1]; `cutoff` cosine of the cone's half angle, [-1, 1]; `e` exponent, at least 0.
/// Returns: `max(c, 0)^e` where `c >= cutoff`, else 0; in [0, 1].
/// Source: Kessenich, Sellers, Shreiner, OpenGL Programming Guide, 9th edition, 2016, example 7.5.
/// Edges: a cone wider than a half space (a `cutoff` below 0) is dark behind the light, where the example takes a power of a negative number; 1 inside the cone for an `e` of 0, as which a negative one counts; a `c` above 1 counts as 1.
/// Error model: that of `safe_pow(c, e)`; either value where `c` and `cutoff` are closer than their errors.
float cone_exponent(float c, float cutoff, float e) {
    return c >= cutoff ? cosine_power(c, e) : 0.0;
}

/// A smooth step from 0 at the outer cone to 1 at the inner one.
///
/// Parameters: `c` cosine of the angle to the axis, [-1, 1]; `inner` and `outer` cosines of the half angles, `inner` above `outer`.
/// Returns: `smoothstep(outer, inner, c)`, in [0, 1].
/// Source: the cubic of the WGSL specification, "smoothstep", with cosines as edges.
/// Edges: a hard edge at `outer`, itself dark, where `inner` is not above `outer`; a `c` outside [-1, 1] is compared as it is.
/// Error model: absolute 1.5*e(t) + 2^-22, with e(t) = 2^-23*(|c| + |outer| + |inner|)/(inner - outer) + 2.5*2^-23.
float cone_smooth(float c, float inner, float outer) {
    float t = clamp((c - outer) / max(inner - outer, 1e-30), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

/// A squared ramp in the cosine, with scale and offset worked out on the host.
///
/// Parameters: `c` cosine of the angle to the axis, [-1, 1]; `scale` of the ramp, 1/max(cos(inner) - cos(outer), 0.001); `offset` of the ramp, -cos(outer)*scale.
/// Returns: `saturate(c*scale + offset)^2`, in [0, 1].
/// Source: Khronos Group, glTF extension KHR_lights_punctual, "Inner and Outer Cone Angles"; Lagarde, de Rousiers, 2014, section 4.5.
/// Edges: the ramp is clamped to [0, 1], whatever `c`, `scale` and `offset` are: a `scale` of 0 leaves `offset` alone.
/// Error model: absolute 2*t*2^-23*(|c*scale| + |offset|) + 0.5 ULP, with t the unsquared ramp.
float cone_scale_offset(float c, float scale, float offset) {
    float t = clamp(c * scale + offset, 0.0, 1.0);
    return t * t;
}

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

#endif
