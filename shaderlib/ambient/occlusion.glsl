//! Ambient occlusion: specular and horizon occlusion, multiple bounces of light, and the terms of GTAO and SSAO.
//!
//! Made from `occlusion.wesl` by `cargo xtask docs`: edit that, not this file.

#ifndef LAMPLIGHT_AMBIENT_OCCLUSION_GLSL
#define LAMPLIGHT_AMBIENT_OCCLUSION_GLSL

#include "../math/noise.glsl"
#include "../math/safe.glsl"

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

/// The share of a reflection that ambient occlusion leaves.
///
/// Parameters: `nv` cosine n.v, [0, 1]; `ao` ambient occlusion, [0, 1], 1 is open; `alpha` squared perceptual roughness, [0, 1].
/// Returns: `(nv + ao)^(2^(-16*alpha - 1)) - 1 + ao`, clamped to [0, 1].
/// Source: Lagarde, de Rousiers, "Moving Frostbite to Physically Based Rendering", 2014, section 4.10.2: an empirical fit, of alpha.
/// Edges: parameters outside [0, 1] are clamped; 1 for an open surface, 0 for a closed one.
/// Error model: absolute 2^-20.
float specular_occlusion(float nv, float ao, float alpha) {
    float power = exp2(-16.0 * clamp(alpha, 0.0, 1.0) - 1.0);
    return clamp(safe_pow(clamp(nv, 0.0, 1.0) + ao, power) - 1.0 + ao, 0.0, 1.0);
}

/// Ambient occlusion with the light that neighbouring surfaces of the same colour reflect.
///
/// Parameters: `ao` ambient occlusion, [0, 1], 1 is open; `albedo` linear colour of the surface, [0, 1].
/// Returns: occlusion by channel, [ao, 1].
/// Source: Jimenez, Wu, Pesce, Jarabo, "Practical Realtime Strategies for Accurate Indirect Occlusion", 2016, equation 10: a cubic fit.
/// Edges: parameters outside [0, 1] are clamped; the fit is 0.01 above 1 for an open white surface, where it is clamped.
/// Error model: absolute 2^-20.
vec3 multibounce(float ao, vec3 albedo) {
    float v = max(ao, 0.0);
    vec3 rho = min(albedo, vec3(1.0));
    vec3 a = 2.0404 * rho - 0.3324;
    vec3 b = -4.7951 * rho + 0.6417;
    vec3 c = 2.7552 * rho + 0.6903;
    return min(max(((a * v + b) * v + c) * v, vec3(v)), vec3(1.0));
}

/// What is left of a reflection that a normal map bends below the surface.
///
/// Parameters: `r` unit, the mirrored direction; `n` unit normal of the geometry, the same space; `k` sharpness, at least 0: 1.3 is usual.
/// Returns: `min(1 + k*dot(r, n), 1)^2`, [0, 1].
/// Source: Russell, "Horizon Occlusion for Normal Mapped Reflections", 2015.
/// Edges: 1 above the horizon, and where `r` or `n` is zero; a negative `k` counts as 0, which gives 1.
/// Error model: absolute 4*2^-23*(1 + k).
float horizon_occlusion(vec3 r, vec3 n, float k) {
    float x = clamp(1.0 + max(k, 0.0) * dot(r, n), 0.0, 1.0);
    return x * x;
}

/// The open part of one side of a slice, weighted by the cosine.
///
/// The ambient occlusion of a slice is the sum of its two sides times the length of the normal projected into it; its mean over slices is 1 where all is open.
///
/// Parameters: `h` angle of the horizon from the viewer's direction, radians, negative on one side; `gamma` angle of the projected normal from the viewer's direction, radians, [-pi/2, pi/2].
/// Returns: `(cos(gamma) + 2*h*sin(gamma) - cos(2*h - gamma))/4`.
/// Source: Jimenez, Wu, Pesce, Jarabo, "Practical Realtime Strategies for Accurate Indirect Occlusion", 2016, equation 7.
/// Edges: `h` is clamped to within pi/2 of the normal: beyond it the surface itself is the horizon; a `gamma` outside its range is not clamped.
/// Error model: absolute 2^-10, of which the bound of WGSL for sines is all but 2^-20.
float gtao_arc(float h, float gamma) {
    float edge = clamp(h, gamma - 1.5707964, gamma + 1.5707964);
    return 0.25 * (cos(gamma) + 2.0 * edge * sin(gamma) - cos(2.0 * edge - gamma));
}

/// A point of a hemisphere for sampling occlusion: more of them near the centre and near the normal.
///
/// Parameters: `i` index, [0, count); `count` number of points, at least 1.
/// Returns: a vector about z, of a length in [0.1, 1]; z is at least 0.
/// Source: cosine-weighted directions at the points of `r2_sequence`; lengths as in Chapman, "SSAO Tutorial", 2013: `mix(0.1, 1, (i/count)^2)`.
/// Edges: a point whose `i` is `count` or more has a length of 1; a `count` of 0 counts as 1.
/// Error model: absolute 2^-11, of which the bound of WGSL for sines is all but 2^-20.
vec3 ssao_kernel(uint i, uint count) {
    vec2 u = r2_sequence(i);
    float phi = 6.2831853 * u.y;
    float share = min(float(i) / float(max(count, 1u)), 1.0);
    vec3 direction = vec3(sqrt(u.x) * cos(phi), sqrt(u.x) * sin(phi), sqrt(1.0 - u.x));
    return direction * (0.1 + 0.9 * share * share);
}

/// The share of a reflection that is open, from the cone of directions that are and the cone of the lobe.
///
/// Parameters: `bent` unit, the mean open direction; `r` unit, the mirrored direction, the same space; `ao` ambient occlusion, [0, 1], 1 is open; `alpha` squared perceptual roughness, [0, 1].
/// Returns: the part of the lobe's cone that the open cone covers, [0, 1].
/// Source: Jimenez, Wu, Pesce, Jarabo, "Practical Realtime Strategies for Accurate Indirect Occlusion", 2016, with the intersection of cones by a smooth step; the cones as in Guy, Agopian, Filament, 2018: cosines `sqrt(1 - ao)` and `2^(-3.321928*alpha^2)`.
/// Edges: fades to 1 for an alpha from 0.09 to 0.01, whose cone has no width; parameters outside [0, 1] are clamped; a zero `bent` or `r` counts as at a right angle.
/// Error model: absolute 2^-9, from the arc cosines.
float gtso(vec3 bent, vec3 r, float ao, float alpha) {
    float a = clamp(alpha, 0.0, 1.0);
    float cos_open = sqrt(1.0 - clamp(ao, 0.0, 1.0));
    float cos_lobe = exp2(-3.321928 * a * a);
    float open = acos(cos_open);
    float lobe = acos(min(cos_lobe, 1.0));
    float apart = acos(clamp(dot(bent, r), -1.0, 1.0));
    // From one cone within the other to two that only touch.
    float within = abs(open - lobe);
    float covered = 1.0 - smoothstep(within, max(open + lobe, within + 1e-4), apart);
    float share = covered * (1.0 - max(cos_open, cos_lobe)) / max(1.0 - cos_lobe, 1e-7);
    return mix(1.0, share, smoothstep(0.01, 0.09, a));
}

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

#endif
