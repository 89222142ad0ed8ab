//! The light loop of the classic books: add up each light's terms, then apply the surface's colour.

#ifndef LAMPLIGHT_LIGHTING_CLASSIC_GLSL
#define LAMPLIGHT_LIGHTING_CLASSIC_GLSL

#include "../brdf/diffuse.glsl"
#include "../brdf/specular.glsl"
#include "light.glsl"
#include "material.glsl"

/// The sums of a light loop. Start from zero.
struct Accum {
    /// Light to be multiplied by the surface's base colour: ambient and diffuse terms.
    vec3 scattered;
    /// Light that keeps its own colour: highlights.
    vec3 reflected;
};

/// A loop's sums with one light added.
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
vec3 resolve(vec3 base, Material material, Accum accum) {
    return material.emission + base * accum.scattered + accum.reflected;
}

/// The visibility of a shadow that takes away only part of the light.
float shadow_mix(float visibility, float strength) {
    return 1.0 - strength * (1.0 - visibility);
}

/// Newcastle's lit colour: highlights weakened by Lambert's term, a tenth of ambient light unattenuated.
vec3 shade_ncl(vec3 base, vec3 color, vec3 n, vec3 l, vec3 v, float attenuation) {
    vec3 surface = base * color;
    vec3 highlight = color * (0.33 * blinn_phong(n, l, v, 50.0));
    return (surface + highlight) * (attenuation * lambert(n, l)) + surface * 0.1;
}

/// The shadowed Phong colour of the book's shadow example.
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

#endif
