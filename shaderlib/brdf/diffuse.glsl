//! Diffuse reflection. `lambert`, `half_lambert`, `wrap` and `oren_nayar` include the cosine n.l, but not the factor 1/pi.
//! `burley` and `eon` are BRDFs: they include 1/pi, but not the cosine. `diffuse_transmission` includes both.
//!
//! Made from `diffuse.wesl` by `cargo xtask docs`: edit that, not this file.

#ifndef LAMPLIGHT_BRDF_DIFFUSE_GLSL
#define LAMPLIGHT_BRDF_DIFFUSE_GLSL

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

/// Lambert's cosine.
///
/// Parameters: `n`, `l` unit, one space, `l` away from the surface.
/// Returns: `max(n.l, 0)`, in [0, 1].
/// Source: Lambert, Photometria, 1760; Kessenich, Sellers, Shreiner, OpenGL Programming Guide, 9th edition, 2016, example 7.3.
/// Edges: 0 where the light is behind the surface, and where `n` or `l` is zero.
/// Error model: absolute 1.5*2^-23*sum|n_i*l_i|.
float lambert(vec3 n, vec3 l) {
    return max(dot(n, l), 0.0);
}

/// Lambert's cosine moved to [0, 1] and squared, so that the dark side keeps some shape.
///
/// Parameters: `n`, `l` unit, one space, `l` away from the surface.
/// Returns: `(0.5*n.l + 0.5)^2`, in [0, 1].
/// Source: Mitchell, McTaggart, Green, "Shading in Valve's Source Engine", 2006.
/// Edges: 0 only where the light is straight behind; 0.25 where `n` or `l` is zero.
/// Error model: absolute 1.5*2^-23*(1 + sum|n_i*l_i|).
float half_lambert(vec3 n, vec3 l) {
    float x = 0.5 * dot(n, l) + 0.5;
    return x * x;
}

/// Lambert's cosine wrapped around the terminator.
///
/// Parameters: `n`, `l` unit, one space, `l` away from the surface; `w` wrap, [0, 1]: 0 is Lambert, 1 reaches the far side.
/// Returns: `max((n.l + w)/(1 + w), 0)`, in [0, 1].
/// Source: Green, "Real-Time Approximations to Subsurface Scattering", GPU Gems, 2004, chapter 16.
/// Edges: a negative `w` counts as 0, one above 1 lights the far side too; `w/(1 + w)` where `n` or `l` is zero.
/// Error model: absolute 2^-24 + 2.5*2^-23*(1 + sum|n_i*l_i|).
float wrap(vec3 n, vec3 l, float w) {
    float amount = max(w, 0.0);
    return max((dot(n, l) + amount) / (1.0 + amount), 0.0);
}

/// Oren and Nayar's qualitative model: diffuse reflection of a rough surface of Lambert facets.
///
/// Parameters: `n`, `l`, `v` unit, one space, `l` and `v` away from the surface; `sigma` standard deviation of the facets' slope, radians, at least 0.
/// Returns: `n.l*(A + B*max(cos(phi), 0)*sin(a)*tan(b))`, at least 0, with `A = 1 - 0.5*sigma^2/(sigma^2 + 0.33)`, `B = 0.45*sigma^2/(sigma^2 + 0.09)`, a and b the larger and the smaller angle of `l` and `v` to `n`, phi the azimuth between `l` and `v`; Lambert's cosine for sigma 0.
/// Source: Oren, Nayar, "Generalization of Lambert's Reflectance Model", 1994, equation 30, without albedo/pi.
/// Edges: 0 where the light is at or behind the horizon, so where `n` or `l` is zero; a viewer behind the surface counts as at the horizon; `n.l*A` for a zero `v`; a negative `sigma` counts as its magnitude.
/// Error model: absolute 2^-18, from the dot products; the quotient is of a cosine by a larger one.
float oren_nayar(vec3 n, vec3 l, vec3 v, float sigma) {
    float nl = dot(n, l);
    if (!(nl > 0.0)) {
        return 0.0;
    }
    float nv = max(dot(n, v), 0.0);
    float s2 = sigma * sigma;
    float a = 1.0 - 0.5 * s2 / (s2 + 0.33);
    float b = 0.45 * s2 / (s2 + 0.09);
    // cos(phi)*sin(theta_l)*sin(theta_v), without an angle.
    float s = max(dot(l, v) - nl * nv, 0.0);
    return nl * a + b * s * (nl / max(nl, nv));
}

/// Disney's diffuse BRDF: Lambert with a retroreflective rim that grows with roughness.
///
/// Parameters: `nl`, `nv`, `lh` cosines n.l, n.v, l.h, [0, 1]; `roughness` perceptual, [0, 1].
/// Returns: `(1 + (f90 - 1)(1 - nl)^5)(1 + (f90 - 1)(1 - nv)^5)/pi` with `f90 = 0.5 + 2*roughness*lh^2`: a BRDF, 1/sr, at least 0; the caller multiplies by `nl`.
/// Source: Burley, "Physically-Based Shading at Disney", 2012, section 5.3.
/// Edges: parameters outside [0, 1] are clamped to it.
/// Error model: 12 ULP.
float burley(float nl, float nv, float lh, float roughness) {
    float half_cosine = clamp(lh, 0.0, 1.0);
    float rise = 2.0 * clamp(roughness, 0.0, 1.0) * half_cosine * half_cosine - 0.5;
    float x = 1.0 - clamp(nl, 0.0, 1.0);
    float y = 1.0 - clamp(nv, 0.0, 1.0);
    float x2 = x * x;
    float y2 = y * y;
    return (1.0 + rise * (x2 * x2 * x)) * (1.0 + rise * (y2 * y2 * y)) * 0.31830989;
}

/// The part of the directional albedo that depends on the direction, in the energy-preserving Oren-Nayar model (EON).
///
/// Parameters: `mu` cosine of the direction, [0, 1].
/// Returns: G/pi, [0, 0.289].
/// Source: Portsmouth, Kutz, Hill, "EON: A Practical Energy-Preserving Rough Diffuse BRDF", 2025, the polynomial.
/// Edges: a cosine outside [0, 1] is clamped to it.
/// Error model: absolute 4*2^-23; the polynomial is within 0.0005 of the integral.
float eon_g(float mu) {
    float m = 1.0 - clamp(mu, 0.0, 1.0);
    return m * (0.057108529 + m * (0.49188187 + m * (0.071442995 * m - 0.33218144)));
}

/// The directional albedo of white rough facets after one reflection, in the energy-preserving Oren-Nayar model (EON).
///
/// Parameters: `mu` cosine of the light's or of the viewer's direction, [0, 1]; `roughness` of the model, [0, 1].
/// Returns: directional albedo, [0, 1]; 1 for a roughness of 0.
/// Source: Portsmouth, Kutz, Hill, "EON: A Practical Energy-Preserving Rough Diffuse BRDF", 2025, the approximate form.
/// Edges: parameters outside [0, 1] are clamped to it; the polynomial is above 1 at the horizon, and clamped to 1.
/// Error model: 8 ULP.
float eon_albedo(float mu, float roughness) {
    float r = clamp(roughness, 0.0, 1.0);
    // 1/2 - 2/(3*pi)
    return min((1.0 + r * eon_g(mu)) / (1.0 + 0.28779341 * r), 1.0);
}

/// The energy-preserving Oren-Nayar model (EON): a rough diffuse surface that loses no light if it is white.
///
/// Parameters: `albedo` linear colour of the facets, [0, 1]; `roughness` of the model, [0, 1]; `nl`, `nv`, `lv` cosines n.l, n.v and l.v.
/// Returns: a BRDF, 1/sr, at least 0; `albedo/pi` for a roughness of 0; the caller multiplies by `nl`.
/// Source: Portsmouth, Kutz, Hill, "EON: A Practical Energy-Preserving Rough Diffuse BRDF", 2025.
/// Edges: 0 where `nl` or `nv` is 0 or below: the light or the viewer is at or behind the horizon; cosines of both below 1e-6 count as 1e-6 in the retroreflection; `albedo` and `roughness` outside [0, 1] are clamped to it, `lv` is not clamped.
/// Error model: 40 ULP beside 2*2^-23*roughness/max(nl, nv).
vec3 eon(vec3 albedo, float roughness, float nl, float nv, float lv) {
    if (!(nl > 0.0 && nv > 0.0)) {
        return vec3(0.0);
    }
    vec3 rho = clamp(albedo, vec3(0.0), vec3(1.0));
    float r = clamp(roughness, 0.0, 1.0);
    float s = lv - nl * nv;
    float t = s > 0.0 ? max(max(nl, nv), 1e-6) : 1.0;
    float a = 1.0 / (1.0 + 0.28779341 * r);
    // What one reflection loses of a direction, and on average: with 2/3 - 28/(15*pi).
    float lost_light = max(0.28779341 - eon_g(nl), 0.0);
    float lost_view = max(0.28779341 - eon_g(nv), 0.0);
    float lost = a * r * 0.2153052;
    // It comes back after several, in a geometric series of the facets' colour.
    vec3 several = rho * rho * ((1.0 - lost) * a * r * lost_light * lost_view * 4.6445696) / (vec3(1.0) - rho * lost);
    return (rho * (a * max(1.0 + r * s / t, 0.0)) + several) * 0.31830989;
}

/// The share of light that Disney's diffuse BRDF reflects into all directions.
///
/// Parameters: `nv` cosine n.v, [0, 1]; `roughness` perceptual, [0, 1].
/// Returns: the directional albedo of `burley`, above 1 at grazing angles of rough surfaces.
/// Source: Hill, in the MaterialX shader library, 2021: a fit.
/// Edges: parameters outside [0, 1] are clamped to it.
/// Error model: 8 ULP; the fit is within 0.02 of the integral.
float burley_albedo(float nv, float roughness) {
    float x = clamp(nv, 0.0, 1.0);
    float r = clamp(roughness, 0.0, 1.0);
    float y = 1.0 - x;
    float y2 = y * y;
    float smooth_end = 0.97619 - 0.488095 * (y2 * y2 * y);
    float rough_end = 1.55754 + x * (-2.02221 + x * (2.56283 - 1.06244 * x));
    return smooth_end + (rough_end - smooth_end) * r;
}

/// Diffuse light of a thin sheet, of which a share passes through.
///
/// Parameters: `nl` cosine n.l, [-1, 1]: negative for a light behind the sheet; `w` share that passes through, [0, 1].
/// Returns: `mix(max(nl, 0), max(-nl, 0), w)/pi`, 1/sr with the cosine in it, [0, 1/pi].
/// Source: Khronos Group, KHR_materials_diffuse_transmission, 2024.
/// Edges: 0 for an `nl` of 0; a `w` outside [0, 1] is clamped to it.
/// Error model: 3 ULP.
float diffuse_transmission(float nl, float w) {
    float share = clamp(w, 0.0, 1.0);
    return (max(nl, 0.0) * (1.0 - share) + max(-nl, 0.0) * share) * 0.31830989;
}

/// Lambert's cosine wrapped around the terminator, with as much light as without.
///
/// Parameters: `nl` cosine n.l, [-1, 1]; `w` wrap, [0, 1]: 0 is Lambert, 1 reaches the far side.
/// Returns: `saturate((nl + w)/(1 + w)^2)`, [0, 1]: its integral over the sphere is pi for every wrap.
/// Source: McAuley, "Energy-Conserving Wrapped Diffuse", 2011; Guy, Agopian, "Physically Based Rendering in Filament", section 4.10.
/// Edges: 0 where `nl` is at or below `-w`: the light is farther behind than the wrap reaches; a negative `w` counts as 0.
/// Error model: absolute 4*2^-23.
float fd_wrap(float nl, float w) {
    float amount = max(w, 0.0);
    float over = 1.0 + amount;
    return clamp((nl + amount) / (over * over), 0.0, 1.0);
}

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

#endif
