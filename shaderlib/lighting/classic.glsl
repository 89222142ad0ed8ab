//! The light loop of the classic books: add up each light's terms, then apply the surface's colour.
//!
//! Made from `classic.wesl` by `cargo xtask docs`: edit that, not this file.

#ifndef LAMPLIGHT_LIGHTING_CLASSIC_GLSL
#define LAMPLIGHT_LIGHTING_CLASSIC_GLSL

#include "../brdf/diffuse.glsl"
#include "../brdf/specular.glsl"
#include "light.glsl"
#include "material.glsl"

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

/// The sums of a light loop. Start from zero.
struct Accum {
    /// Light to be multiplied by the surface's base colour: ambient and diffuse terms.
    vec3 scattered;
    /// Light that keeps its own colour: highlights.
    vec3 reflected;
};

/// A loop's sums with one light added.
///
/// Attenuation and cone come with `lit`, the shape of the reflection with `diffuse` and `specular`, and the shadow
/// with `visibility`: each is computed by a function of its own, and multiplied here for the first time.
/// Ambient light is not shadowed. Its factor is `lit.attenuation * lit.spot` in the book's light loop, 1 in its earlier examples.
///
/// Parameters: `accum` sums so far; `material` reflectances; `light` colours and strength; `lit` factors at the point; `ambient` factor on ambient light, [0, 1]; `diffuse` and `specular` terms of the reflection, at least 0, as from `lambert` and `blinn_phong`; `visibility` unshadowed share, [0, 1].
/// Returns: sums with the light's terms added, linear.
/// Source: Kessenich, Sellers, Shreiner, OpenGL Programming Guide, 9th edition, 2016, examples 7.8 and 7.10.
/// Edges: if `lit` comes from `sample_light`, a light that is off adds nothing but its ambient light, which is 0 if `ambient` is 0; no parameter is clamped.
/// Error model: 4 ULP + absolute 8*2^-23 of the largest term.
Accum accumulate(
    Accum accum,
    Material material,
    Light light,
    LightSample lit,
    float ambient,
    float diffuse,
    float specular,
    float visibility
) {
    vec3 arriving = light.color * (lit.attenuation * lit.spot * visibility);
    return Accum(
        accum.scattered + light.ambient * material.ambient * ambient + arriving * material.diffuse * diffuse,
        accum.reflected + arriving * material.specular * (specular * light.strength)
    );
}

/// The colour that leaves the surface, from the sums of a light loop.
///
/// Parameters: `base` the surface's linear colour, [0, 1]; `material` its `emission` is read; `accum` the loop's sums.
/// Returns: `emission + base*scattered + reflected`, linear, not clamped.
/// Source: Kessenich, Sellers, Shreiner, OpenGL Programming Guide, 9th edition, 2016, examples 7.8 and 7.10, without their clamp to 1.
/// Edges: no parameter is clamped: negative sums take light away.
/// Error model: 2 ULP + absolute 2^-23, beside the sums' own errors.
vec3 resolve(vec3 base, Material material, Accum accum) {
    return material.emission + base * accum.scattered + accum.reflected;
}

/// The visibility of a shadow that takes away only part of the light.
///
/// Parameters: `visibility` unshadowed share, [0, 1]; `strength` how much a full shadow takes away, [0, 1].
/// Returns: `1 - strength*(1 - visibility)`, in [0, 1].
/// Source: Movania et al., OpenGL: Build High Performance Graphics, 2017, chapter 4, shadow mapping: a strength of 0.5.
/// Edges: 1 for a `strength` of 0, `visibility` for a `strength` of 1; neither is clamped.
/// Error model: absolute 2^-23.
float shadow_mix(float visibility, float strength) {
    return 1.0 - strength * (1.0 - visibility);
}

/// Newcastle's lit colour: highlights weakened by Lambert's term, a tenth of ambient light unattenuated.
///
/// Parameters: `base` surface's linear colour, [0, 1]; `color` light's linear colour; `n`, `l`, `v` unit, one space, `l` and `v` away from the surface; `attenuation` of the light, [0, 1], `linear_radius` in the tutorial.
/// Returns: `(base*color + color*0.33*max(n.h, 0)^50)*attenuation*max(n.l, 0) + 0.1*base*color`, linear.
/// Source: Newcastle University, Graphics for Games, tutorial 11 "Real-Time Lighting A": its code, which multiplies the highlight by Lambert's term; its text does not.
/// Edges: ambient light alone where the light is behind the surface, so where `n` or `l` is zero; no highlight where `l = -v`, and one about `l` for a zero `v`; `base`, `color` and `attenuation` are not clamped.
/// Error model: that of `blinn_phong` at 50 on the highlight + 4 ULP of the sum of terms.
vec3 shade_ncl(vec3 base, vec3 color, vec3 n, vec3 l, vec3 v, float attenuation) {
    vec3 surface = base * color;
    vec3 highlight = color * (0.33 * blinn_phong(n, l, v, 50.0));
    return (surface + highlight) * (attenuation * min(lambert(n, l), 1.0)) + surface * 0.1;
}

/// The shadowed Phong colour of the book's shadow example.
///
/// The book mixes spaces: it leaves `n` as interpolated in eye space and takes `l` in world space. Here both are the caller's.
///
/// Parameters: `ambient`, `diffuse`, `specular` linear reflected colours; `power` exponent, at least 0; `n`, `l`, `v` as for `phong_oglpg_7_21`; `visibility` the shadow lookup, [0, 1].
/// Returns: `ambient + visibility*(diffuse*max(n.l, 0) + specular*phong)`, linear, not clamped.
/// Source: Kessenich, Sellers, Shreiner, OpenGL Programming Guide, 9th edition, 2016, example 7.21.
/// Edges: as `phong_oglpg_7_21`: indeterminate where the mirrored ray points away from the viewer, highlights behind the surface.
/// Error model: that of `phong_oglpg_7_21` on the highlight + 3 ULP of the sum of terms.
vec3 shade_oglpg_7_21(
    vec3 ambient,
    vec3 diffuse,
    vec3 specular,
    float power,
    vec3 n,
    vec3 l,
    vec3 v,
    float visibility
) {
    vec3 lit = diffuse * lambert(n, l) + specular * phong_oglpg_7_21(n, l, v, power);
    return ambient + visibility * lit;
}

#ifdef LAMPLIGHT_PREFIX
#include "../prefix.glsl"
#endif

#endif
