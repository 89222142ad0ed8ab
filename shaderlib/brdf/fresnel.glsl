//! Fresnel reflectance: of dielectrics and conductors exactly, and in the forms that materials are described with.
//!
//! Made from `fresnel.wesl` by `cargo xtask docs`: edit that, not this file.

#ifndef LAMPLIGHT_BRDF_FRESNEL_GLSL
#define LAMPLIGHT_BRDF_FRESNEL_GLSL

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

/// Reflectance at normal incidence from an index of refraction.
///
/// Parameters: `eta` index of refraction of the far side over that of the near side, at least 0.
/// Returns: `((eta - 1)/(eta + 1))^2`, in [0, 1].
/// Source: Fresnel's equations at normal incidence; Khronos Group, KHR_materials_ior, 2021.
/// Edges: 1 for 0, the value that KHR_materials_ior gives a full reflection; a negative `eta` counts as 0.
/// Error model: 8 ULP.
float f0_from_ior(float eta) {
    float e = max(eta, 0.0);
    float r = (e - 1.0) / (e + 1.0);
    return r * r;
}

/// The index of refraction, above 1, that reflects a given share at normal incidence.
///
/// Parameters: `f0` reflectance at normal incidence, [0, 1].
/// Returns: `(1 + sqrt(f0))/(1 - sqrt(f0))`, at least 1.
/// Source: the inverse of `f0_from_ior`; the form with `1 - f0` keeps the digits that `1 - sqrt(f0)` loses.
/// Edges: a reflectance above 0.9999 counts as 0.9999, one below 0 as 0: the result is at most 40000.
/// Error model: 14 ULP.
float ior_from_f0(float f0) {
    float f = clamp(f0, 0.0, 0.9999);
    float s = 1.0 + sqrt(f);
    return s * s / (1.0 - f);
}

/// The reflectance of a smooth dielectric for unpolarised light.
///
/// Both amplitudes are written with the factor `eta^2 - 1` taken out, so that nothing cancels for indices close to 1 and at Brewster's angle.
///
/// Parameters: `mu` cosine of the angle of incidence, [0, 1]; `eta` index of refraction of the far side over that of the near side, at least 0.
/// Returns: reflectance, [0, 1]; 1 beyond the critical angle of an `eta` below 1.
/// Source: Cook, Torrance, "A Reflectance Model for Computer Graphics", 1982; Lagarde, "Memo on Fresnel equations", 2013.
/// Edges: a `mu` outside [0, 1] is clamped to it; 0 for an `eta` of 1 at every angle; a negative `eta` counts as 0, which reflects everything, one above 1e9 as that.
/// Error model: relative 40*2^-23; near the critical angle absolute 8*2^-23/g, with `g^2 = eta^2 - 1 + mu^2`.
float f_dielectric(float mu, float eta) {
    float c = clamp(mu, 0.0, 1.0);
    float n = clamp(eta, 0.0, 1e9);
    float e = (n - 1.0) * (n + 1.0);
    if (e == 0.0) {
        return 0.0;
    }
    float g2 = e + c * c;
    if (!(g2 > 0.0)) {
        return 1.0;
    }
    float g = sqrt(g2);
    float across = e / (g + c) / (g + c);
    float n2c = n * n * c;
    float along = e / (n2c + g) * (((n * n + 1.0) * c * c - 1.0) / (n2c + g));
    return min(0.5 * (across * across + along * along), 1.0);
}

/// One wavelength of `f_conductor`.
///
/// Parameters: `c` cosine of the angle of incidence, [1e-7, 1]; `n`, `k` real and imaginary part of the index of refraction, [1e-4, 1e4] and [0, 1e4].
/// Returns: reflectance, [0, 1].
/// Source: as `f_conductor`.
/// Edges: as `f_conductor`, without its clamping.
/// Error model: as `f_conductor`.
float f_conductor_channel(float c, float n, float k) {
    float c2 = c * c;
    float s2 = (1.0 - c) * (1.0 + c);
    // n^2 - s^2, where s^2 = 1 - c^2 would lose the digits of an index close to 1.
    float n2s2 = n < 0.5 ? n * n - s2 : (n - 1.0) * (n + 1.0) + c2;
    float t = n2s2 - k * k;
    float nk = n * k;
    float q = length(vec2(t, 2.0 * nk));
    // The root of half of q + t, which cancels for t below 0.
    float b = sqrt(0.5 * (q + abs(t)));
    float a = t < 0.0 ? nk / b : b;
    float across = 1.0 - 4.0 * a * c / (q + c2 + 2.0 * a * c);
    float ratio = 1.0 - 4.0 * a * c * s2 / (c2 * q + s2 * s2 + 2.0 * a * c * s2);
    return max(0.5 * across * (1.0 + ratio), 0.0);
}

/// The reflectance of a smooth conductor for unpolarised light, for three wavelengths.
///
/// Parameters: `mu` cosine of the angle of incidence, [0, 1]; `n`, `k` real and imaginary part of the index of refraction, over that of the near side, at least 0.
/// Returns: reflectance, [0, 1]; that of the dielectric `n` for a `k` of 0.
/// Source: Lagarde, "Memo on Fresnel equations", 2013; Pharr, Jakob, Humphreys, Physically Based Rendering, 4th edition, 2023, section 9.3.6.
/// Edges: a `mu` outside [1e-7, 1] is clamped to it, `n` to [1e-4, 1e4], `k` to [0, 1e4]: beyond, the squares would overflow or vanish.
/// Error model: absolute 8*2^-23; near the critical angle of an `n` below 1 with a `k` near 0 also 8*2^-23/sqrt(q), `q^2 = (n^2 - k^2 - s^2)^2 + (2*n*k)^2`, s the sine.
vec3 f_conductor(float mu, vec3 n, vec3 k) {
    float c = clamp(mu, 1e-7, 1.0);
    return vec3(
        f_conductor_channel(c, clamp(n.x, 1e-4, 1e4), clamp(k.x, 0.0, 1e4)),
        f_conductor_channel(c, clamp(n.y, 1e-4, 1e4), clamp(k.y, 0.0, 1e4)),
        f_conductor_channel(c, clamp(n.z, 1e-4, 1e4), clamp(k.z, 0.0, 1e4))
    );
}

/// Schlick's approximation with a colour for the dip near 82 degrees that metals have.
///
/// Parameters: `f0` linear reflectance at normal incidence, [0, 1]; `tint` what the reflectance at the cosine 1/7 is multiplied by, [0, 1]; `mu` cosine of the angle of incidence, [0, 1].
/// Returns: `S(mu) - mu*(1 - mu)^6/(m*(1 - m)^6)*S(m)*(1 - tint)`, m = 1/7, S Schlick's approximation with 1 at grazing incidence; at least 0.
/// Source: Kutz, Hašan, Edmondson, "Novel aspects of the Adobe Standard Material", 2021; Academy Software Foundation, OpenPBR Surface 1.1, 2024.
/// Edges: a `mu` outside [0, 1] is clamped to it; a dark `f0` with a dark `tint` would fall below 0 between 1/7 and 1, and is 0 there; neither is clamped.
/// Error model: absolute 8*2^-23.
vec3 f_schlick_f82(vec3 f0, vec3 tint, float mu) {
    float c = clamp(mu, 0.0, 1.0);
    float x = 1.0 - c;
    float x2 = x * x;
    float x5 = x2 * x2 * x;
    vec3 schlick = f0 + (vec3(1.0) - f0) * x5;
    // (6/7)^5, and 1/(m*(1 - m)^6).
    vec3 at_dip = f0 + (vec3(1.0) - f0) * 0.46266437;
    vec3 dip = at_dip * (vec3(1.0) - tint) * (17.651386 * c * x5 * x);
    return max(schlick - dip, vec3(0.0));
}

/// The average of Schlick's reflectance over the hemisphere, weighted by the cosine.
///
/// Parameters: `f0`, `f90` linear reflectance at normal and at grazing incidence, [0, 1].
/// Returns: `f0 + (f90 - f0)/21`, between the two.
/// Source: Jakob et al., "A Comprehensive Framework for Rendering Layered Materials", 2014: the integral of `2*mu*(1 - mu)^5` is 1/21.
/// Edges: neither `f0` nor `f90` is clamped: the result is between the two, whatever they are.
/// Error model: absolute 3*2^-23*max(f0, f90).
vec3 f_average_schlick(vec3 f0, vec3 f90) {
    return f0 + (f90 - f0) * 0.047619048;
}

/// The average of the reflectance of a smooth dielectric over the hemisphere, weighted by the cosine.
///
/// Fitted to the integral of `f_dielectric` for 238 indices above 1. Below 1, the share that leaves the denser side follows from the share that enters it.
///
/// Parameters: `eta` index of refraction of the far side over that of the near side, at least 0.
/// Returns: the integral of `2*mu*F(mu, eta)` over the cosine `mu`, [0, 1].
/// Source: Walsh, "The reflection factor of a polished glass surface for diffused light", 1926, has the integral; the coefficients are this library's. Below 1, `1 - eta^2*(1 - E(1/eta))`: Duntley, "The Optical Properties of Diffusing Materials", 1942.
/// Edges: 0 for an `eta` of 1; 1 for 0 or below, an `eta` above 1e6 counts as 1e6.
/// Error model: absolute 2^-18; the fit is within 0.0001 of the integral.
float f_average_dielectric(float eta) {
    float n = clamp(eta, 0.0, 1e6);
    float t = abs(n - 1.0) / (n + 1.0);
    float over = t * (0.630748 + t * (1.559664 + t * (0.58983 - 2.30022 * t)));
    float under = 1.0 + t * (7.526047 + t * (-11.661933 + 3.615908 * t));
    float e = clamp(over / under, 0.0, 1.0);
    return n >= 1.0 ? e : 1.0 - n * n * (1.0 - e);
}

/// Three indices of refraction with their imaginary parts, as metals have.
struct ComplexIor {
    /// Real part.
    vec3 n;
    /// Imaginary part: extinction.
    vec3 k;
};

/// The index of refraction of a metal from two colours, for `f_conductor`.
///
/// Parameters: `r` linear reflectance at normal incidence, [0, 1]; `g` colour of the edge, [0, 1]: a larger one brightens the reflectance near grazing incidence less late.
/// Returns: indices with which `f_conductor` gives `r` at normal incidence: `n = mix((1 + sqrt(r))/(1 - sqrt(r)), (1 - r)/(1 + r), g)` and `k^2 = (r*(n + 1)^2 - (n - 1)^2)/(1 - r)`.
/// Source: Gulbrandsen, "Artist Friendly Metallic Fresnel", 2014.
/// Edges: a reflectance above 0.999 counts as 0.999, whose index is at most 3998; colours outside [0, 1] are clamped to it; `k` is 0 for a black `r` or `g`.
/// Error model: 24 ULP.
ComplexIor ior_artistic(vec3 r, vec3 g) {
    vec3 f = clamp(r, vec3(0.0), vec3(0.999));
    vec3 edge = clamp(g, vec3(0.0), vec3(1.0));
    vec3 s = sqrt(f);
    vec3 most = (1.0 + s) * (1.0 + s) / (1.0 - f);
    vec3 least = (1.0 - f) / (1.0 + f);
    vec3 n = most * (1.0 - edge) + least * edge;
    // k^2 with both squares of its difference multiplied out: nothing is left that cancels.
    vec3 k = 2.0 * s / (1.0 + f) * sqrt(edge * (1.0 + (1.0 - edge) * most * most));
    return ComplexIor(n, k);
}

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

#endif
