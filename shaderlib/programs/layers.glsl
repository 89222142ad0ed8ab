//! The layers of a glTF surface, for `forward` and `deferred` with `metallic_roughness`.
//!
//! From above: the coat, the sheen, and the base. The base is a mix of a metal and a dielectric,
//! with the colours of a thin film in the Fresnel term of both. What a dielectric does not reflect
//! is scattered to the viewer's side or through the surface, or passes it. Each layer takes from the
//! layers below it what it reflects, as the extensions of glTF say (Khronos Group, KHR_materials_*).
//!
//! Light is in the unit of `forward`: a lamp of colour 1 gives a white matt surface that faces it
//! the colour 1, and so do surroundings of radiance 1. So a lobe is multiplied by pi. Highlights of
//! rough facets are scaled up by what single scattering loses (`energy_compensation`). Highlights are
//! never narrower than those of `LEAST_ALPHA`; what is mirrored of the surroundings is.
//!
//! Made from `layers.wesl` by `cargo xtask docs`: edit that, not this file.

#ifndef LAMPLIGHT_PROGRAMS_LAYERS_GLSL
#define LAMPLIGHT_PROGRAMS_LAYERS_GLSL

#if CLEARCOAT
#include "../brdf/coat.glsl"
#endif
#if DIFFUSE_TRANSMISSION
#include "../brdf/diffuse.glsl"
#endif
#include "../brdf/energy.glsl"
#if IRIDESCENCE
#include "../brdf/film.glsl"
#endif
#if ANISOTROPY
#include "../brdf/microfacet.glsl"
#endif
#if SHEEN
#include "../brdf/sheen.glsl"
#endif
#include "../brdf/specular.glsl"
#include "../brdf/transmission.glsl"
#if ANISOTROPY
#include "../math/safe.glsl"
#endif
#if AREA == AREA_SPHERE || AREA == AREA_TUBE
#include "areas.glsl"
#endif

/// A material of glTF beside what `Material` has of it: its emission and its roughness. The
/// comments name the factors of the extensions.
layout(std140, set = 1, binding = 5) uniform Layers {
    /// Linear: KHR_materials_specular, specularColorFactor.
    vec3 specular_color;
    /// [0, 1]: KHR_materials_specular, specularFactor.
    float specular;
    /// `sheen`: linear, KHR_materials_sheen, sheenColorFactor.
    vec3 sheen_color;
    /// `sheen`: perceptual, [0, 1].
    float sheen_roughness;
    /// `volume`: linear, [0, 1]: KHR_materials_volume, attenuationColor.
    vec3 attenuation_color;
    /// `volume`: scene units; 0 where the volume absorbs nothing.
    float attenuation_distance;
    /// `diffuse_transmission`: linear, diffuseTransmissionColorFactor.
    vec3 diffuse_transmission_color;
    /// `diffuse_transmission`: share of the scattered light that passes, [0, 1].
    float diffuse_transmission;
    /// `anisotropy`: cosine and sine of anisotropyRotation, from the tangent towards the bitangent.
    vec2 anisotropy_direction;
    /// `anisotropy`: anisotropyStrength, [0, 1].
    float anisotropy;
    /// metallicFactor, [0, 1].
    float metallic;
    /// Index of refraction: KHR_materials_ior; 1.5 where it is not given.
    float ior;
    /// Factor on the emission: KHR_materials_emissive_strength.
    float emissive_strength;
    /// `clearcoat`: clearcoatFactor, [0, 1].
    float clearcoat;
    /// `clearcoat`: perceptual, [0, 1].
    float clearcoat_roughness;
    /// `iridescence`: iridescenceFactor, [0, 1].
    float iridescence;
    /// `iridescence`: index of refraction of the film.
    float iridescence_ior;
    /// `iridescence`: thickness of the film, nanometres; without one, there is no film.
    float iridescence_thickness;
    /// `transmission`: transmissionFactor, [0, 1].
    float transmission;
    /// `volume`: thicknessFactor, scene units; 0 for a thin surface.
    float thickness;
    /// `dispersion`: 20 over the Abbe number.
    float dispersion;
    /// `ambient=ibl`: levels of `sky_specular`, even in perceptual roughness; 1 where it has one.
    float sky_levels;
    /// `iridescence`, `material_maps`: thickness of the film where green is 0, nanometres.
    float iridescence_least;
} layers;

/// The factors of `Layers` that textures multiply, at a point.
struct Factors {
    vec3 specular_color;
    float specular;
    vec3 sheen_color;
    float sheen_roughness;
    vec3 diffuse_transmission_color;
    float diffuse_transmission;
    vec2 anisotropy_direction;
    float anisotropy;
    float metallic;
    float clearcoat;
    float clearcoat_roughness;
    float iridescence;
    float iridescence_thickness;
    float transmission;
    float thickness;
};

/// Zero in every member of `Factors`.
Factors zero_factors() {
    Factors zero;
    zero.specular_color = vec3(0.0);
    zero.specular = 0.0;
    zero.sheen_color = vec3(0.0);
    zero.sheen_roughness = 0.0;
    zero.diffuse_transmission_color = vec3(0.0);
    zero.diffuse_transmission = 0.0;
    zero.anisotropy_direction = vec2(0.0);
    zero.anisotropy = 0.0;
    zero.metallic = 0.0;
    zero.clearcoat = 0.0;
    zero.clearcoat_roughness = 0.0;
    zero.iridescence = 0.0;
    zero.iridescence_thickness = 0.0;
    zero.transmission = 0.0;
    zero.thickness = 0.0;
    return zero;
}

/// The facets of a surface as the viewer sees them: what their lobe does not have of the light.
struct Facets {
    vec3 normal;
    /// Cosine towards the viewer, and the same without a sign.
    float toward;
    float nv;
    float alpha;
    /// What the facets hide from the viewer, in the Smith visibility.
    float hidden;
};

/// What lies half way between a light and the viewer.
struct HalfWay {
    /// The sum of both directions, and its squared length.
    vec3 sum;
    float size2;
    /// The fifth power of Schlick's approximation.
    float rim;
};

/// A point of a layered surface, as far as it does not depend on lights. Every permutation has all
/// members, so that functions are the same in all of them; without an extension, its members are
/// neither set nor read, and drivers remove them.
struct Layered {
    vec3 normal;
    vec3 view;
    float nv;
    /// The base colour.
    vec3 base;
    float roughness;
    Factors own;
    /// Reflectance of the dielectric at normal incidence, without its weight.
    vec3 f0;
    /// Scale and offset of the base's albedo.
    vec2 dfg;
    /// The facets of the base.
    Facets facets;
    /// What a lamp's light is scattered with, before what is reflected of it.
    vec3 scattering;
    /// What the lobe of the base is multiplied by, where Schlick's power is 0, and what it gains up to 1:
    /// the blend of the dielectric and the metal, with their compensations.
    vec3 reflecting;
    vec3 rising;
    /// The largest channel of the dielectric's reflectance in the same way.
    vec2 taken;
    /// The reflectance of the dielectric, by its weight, and of the metal at normal incidence.
    vec3 blend;
    /// `iridescence`: reflectance of the film towards the viewer.
    vec3 film;
    /// `anisotropy`: unit, along the brush.
    vec3 tangent;
    vec3 bitangent;
    /// `anisotropy`: along the tangent and the bitangent.
    vec2 alphas;
    /// `clearcoat`: its facets, and its unit normal.
    Facets coat_facets;
    vec3 coat_normal;
    /// `clearcoat`: share of the light that the coat reflects towards the viewer.
    float coat_share;
    /// `clearcoat`: what the coat's single scattering is multiplied by.
    float coat_gain;
    /// `sheen`: albedo of a white sheen towards the viewer.
    float sheen_view;
    /// `volume`: share of the light that the volume lets through.
    vec3 passing;
};

/// Zero in every member of `Layered`.
Layered zero_layered() {
    Layered zero;
    zero.normal = vec3(0.0);
    zero.view = vec3(0.0);
    zero.nv = 0.0;
    zero.base = vec3(0.0);
    zero.roughness = 0.0;
    zero.own = zero_factors();
    zero.f0 = vec3(0.0);
    zero.dfg = vec2(0.0);
    zero.facets = Facets(vec3(0.0), 0.0, 0.0, 0.0, 0.0);
    zero.scattering = vec3(0.0);
    zero.reflecting = vec3(0.0);
    zero.rising = vec3(0.0);
    zero.taken = vec2(0.0);
    zero.blend = vec3(0.0);
    zero.film = vec3(0.0);
    zero.tangent = vec3(0.0);
    zero.bitangent = vec3(0.0);
    zero.alphas = vec2(0.0);
    zero.coat_facets = Facets(vec3(0.0), 0.0, 0.0, 0.0, 0.0);
    zero.coat_normal = vec3(0.0);
    zero.coat_share = 0.0;
    zero.coat_gain = 0.0;
    zero.sheen_view = 0.0;
    zero.passing = vec3(0.0);
    return zero;
}

/// The light around a layered surface: irradiance over pi, or radiance blurred by the roughness.
struct Around {
    /// Onto the viewer's side.
    vec3 front;
    /// `diffuse_transmission`: onto the other side.
    vec3 back;
    /// From the direction that the base mirrors.
    vec3 mirrored;
    /// `clearcoat`: from the direction that the coat mirrors.
    vec3 coated;
    /// `transmission`: from the directions that are seen through the surface, one for each channel.
    vec3 through;
};

/// The factors where no texture multiplies them.
Factors plain_factors() {
    Factors own = zero_factors();
    own.specular_color = layers.specular_color;
    own.specular = layers.specular;
    own.metallic = layers.metallic;
#if SHEEN
    own.sheen_color = layers.sheen_color;
    own.sheen_roughness = layers.sheen_roughness;
#endif
#if DIFFUSE_TRANSMISSION
    own.diffuse_transmission_color = layers.diffuse_transmission_color;
    own.diffuse_transmission = layers.diffuse_transmission;
#endif
#if ANISOTROPY
    own.anisotropy_direction = layers.anisotropy_direction;
    own.anisotropy = layers.anisotropy;
#endif
#if CLEARCOAT
    own.clearcoat = layers.clearcoat;
    own.clearcoat_roughness = layers.clearcoat_roughness;
#endif
#if IRIDESCENCE
    own.iridescence = layers.iridescence;
    own.iridescence_thickness = layers.iridescence_thickness;
#endif
#if TRANSMISSION
    own.transmission = layers.transmission;
#endif
#if VOLUME
    own.thickness = layers.thickness;
#endif
    return own;
}

/// The cosine towards the viewer, without a sign. A normal that is bent or interpolated points away from
/// the viewer just inside of outlines, where the surface is seen nevertheless: Khronos Group, glTF 2.0,
/// appendix B, which has `|n.v|`. At 0 the visibility of facets would be 0, and its limit is not.
float seen_cosine(vec3 normal, vec3 view) {
    return clamp(abs(dot(normal, view)), 1e-4, 1.0);
}

/// The facets of a surface of a perceptual roughness.
Facets facets_of(vec3 normal, vec3 view, float roughness) {
    float alpha = min(max(roughness * roughness, LEAST_ALPHA), 1.0);
    float a2 = alpha * alpha;
    float nv = seen_cosine(normal, view);
    return Facets(normal, dot(normal, view), nv, alpha, sqrt(nv * nv * (1.0 - a2) + a2));
}

/// The largest channel.
float largest_channel(vec3 color) {
    return max(max(color.x, color.y), color.z);
}

/// The surface with what the lights of all lamps have in common.
Layered ready(Layered surface) {
    Layered at = surface;
    float weight = (1.0 - at.own.metallic) * at.own.specular;
    float gain = energy_compensation(vec3(1.0), at.dfg).x - 1.0;
    vec3 of_dielectric = weight + at.f0 * (weight * gain);
    vec3 of_metal = at.own.metallic + at.base * (at.own.metallic * gain);
    at.reflecting = of_dielectric * at.f0 + of_metal * at.base;
    at.rising = of_dielectric + of_metal - at.reflecting;
    at.blend = at.f0 * weight + at.base * at.own.metallic;
    float most = largest_channel(at.f0);
    at.taken = at.own.specular * vec2(most, 1.0 - most);
#if IRIDESCENCE
    float plain = 1.0 - at.own.iridescence;
    at.reflecting = at.reflecting * plain + (of_dielectric + of_metal) * at.film * at.own.iridescence;
    at.rising *= plain;
    at.taken = at.taken * plain + vec2(at.own.specular * largest_channel(at.film) * at.own.iridescence, 0.0);
#endif
#if !TRANSMISSION && !DIFFUSE_TRANSMISSION
    at.scattering = at.base * (1.0 - at.own.metallic);
#else
    at.scattering = vec3(1.0 - at.own.metallic);
#endif
    return at;
}

/// The surface at a point.
Layered layered(vec3 base, float roughness, vec3 normal, vec3 view, Factors own) {
    Layered at = zero_layered();
    at.own = own;
    at.normal = normal;
    at.view = view;
    at.nv = seen_cosine(normal, view);
    at.base = base;
    at.roughness = clamp(roughness, 0.0, 1.0);
    at.f0 = specular_f0(layers.ior, 1.0, at.own.specular_color);
    at.dfg = dfg_approx(at.nv, at.roughness);
    at.facets = facets_of(normal, view, at.roughness);
#if IRIDESCENCE
    // Schlick's form lets a film without thickness reflect at grazing angles, so it is left out, as in
    // Khronos Group's glTF Sample Renderer, which also has the film's colours of the viewer's angle.
    at.own.iridescence = own.iridescence_thickness > 0.0 ? own.iridescence : 0.0;
    at.film = iridescence(1.0, layers.iridescence_ior, mix(at.f0, base, own.metallic), at.own.iridescence_thickness, at.nv);
#endif
#if SHEEN
    at.sheen_view = sheen_albedo(at.nv, at.own.sheen_roughness * at.own.sheen_roughness);
#endif
#if VOLUME
    at.passing = volume_transmittance(layers.attenuation_color, at.own.thickness, layers.attenuation_distance);
#endif
    return ready(at);
}

#if ANISOTROPY
/// The surface, brushed along its tangent, which has the sign of the bitangent in `w`.
Layered brushed(Layered surface, vec4 tangent) {
    Layered at = surface;
    at.alphas = alpha_aniso(max(at.roughness * at.roughness, LEAST_ALPHA), at.own.anisotropy);
    // The isotropic surface whose facets are as wide.
    at.dfg = dfg_approx(at.nv, sqrt(sqrt(at.alphas.x * at.alphas.y)));
    vec3 along = normalize_or_zero(tangent.xyz - at.normal * dot(at.normal, tangent.xyz));
    vec3 across = cross(at.normal, along) * tangent.w;
    at.tangent = along * at.own.anisotropy_direction.x + across * at.own.anisotropy_direction.y;
    at.bitangent = cross(at.normal, at.tangent);
    vec2 seen = vec2(dot(at.tangent, at.view), dot(at.bitangent, at.view)) * at.alphas;
    at.facets.hidden = length(vec3(seen, at.nv));
    return ready(at);
}
#endif

#if CLEARCOAT
/// The surface with a coat, whose normal no texture bends.
Layered coated(Layered surface, vec3 coat_normal) {
    Layered at = surface;
    at.coat_facets = facets_of(coat_normal, at.view, at.own.clearcoat_roughness);
    at.coat_normal = coat_normal;
    at.coat_share = at.own.clearcoat * f_schlick(vec3(0.04), 1.0, at.coat_facets.nv).x;
    at.coat_gain = energy_compensation(vec3(1.0), dfg_approx(at.coat_facets.nv, at.own.clearcoat_roughness)).x;
    return at;
}
#endif

/// The reflectance that the base's albedo is computed with.
vec3 mean_reflectance(Layered at, vec3 f0) {
#if !IRIDESCENCE
    return f0;
#else
    return mix(f0, at.film, at.own.iridescence);
#endif
}

/// Half way between the unit directions to a light and to the viewer.
HalfWay half_way(vec3 l, vec3 view) {
    vec3 sum = l + view;
    float size2 = dot(sum, sum);
    // The cosine between the viewer and the half vector is half the length of the sum.
    float x = clamp(1.0 - 0.5 * sqrt(size2), 0.0, 1.0);
    float x2 = x * x;
    return HalfWay(sum, size2, x2 * x2 * x);
}

/// The microfacets of a surface that reflects everything, times pi and n.l: `d_ggx` and `v_smith_ggx`
/// over one denominator, which the length of the half vector has been taken out of.
float facets(Facets at, float nl, HalfWay half_) {
    vec3 across = cross(at.normal, half_.sum);
    float along = (nl + at.toward) * at.alpha;
    float spread = dot(across, across) + along * along;
    float a2 = at.alpha * at.alpha;
    float lit = max(nl, 0.0);
    float visible = lit * at.hidden + at.nv * sqrt(lit * lit * (1.0 - a2) + a2);
    float peak = at.alpha * half_.size2;
    return 0.5 * lit * peak * peak / (spread * spread * visible + 1e-30);
}

#if ANISOTROPY
/// The same for a brushed surface, by `d_ggx_aniso` and `v_smith_ggx_aniso`.
float brushed_facets(Layered at, vec3 l, float nl, HalfWay half_) {
    float a2 = at.alphas.x * at.alphas.y;
    float t = dot(at.tangent, half_.sum) * at.alphas.y;
    float b = dot(at.bitangent, half_.sum) * at.alphas.x;
    float along = (nl + at.facets.toward) * a2;
    float spread = t * t + b * b + along * along;
    float lit = max(nl, 0.0);
    vec2 seen = vec2(dot(at.tangent, l), dot(at.bitangent, l)) * at.alphas;
    float visible = lit * at.facets.hidden + at.nv * length(vec3(seen, lit));
    float peak = a2 * half_.size2;
    return 0.5 * lit * a2 * peak * peak / (spread * spread * visible + 1e-30);
}
#endif

#if TRANSMISSION || DIFFUSE_TRANSMISSION
/// How much of the light in the body reaches its other side.
vec3 passing_share(Layered at) {
#if VOLUME
    return at.passing;
#else
    return vec3(1.0);
#endif
}
#endif

#if TRANSMISSION
/// How rough the surface is for what is seen through it.
float through_roughness(Layered at) {
#if VOLUME
    return at.own.thickness > 0.0 ? transmission_roughness(at.roughness, layers.ior) : at.roughness;
#else
    return at.roughness;
#endif
}
#endif

#if !TRANSMISSION && !DIFFUSE_TRANSMISSION
/// What a dielectric does with the light of a lamp that it does not reflect. Without a share that passes,
/// this is a cosine, and the colour of the base is in `scattering`.
vec3 below_light(Layered at, vec3 l, float nl) {
    return vec3(nl);
}
#else
vec3 below_light(Layered at, vec3 l, float nl) {
#if !DIFFUSE_TRANSMISSION
    vec3 scattered = at.base * max(nl, 0.0);
#endif
#if DIFFUSE_TRANSMISSION
    float before = diffuse_transmission(max(nl, 0.0), at.own.diffuse_transmission);
    float behind = diffuse_transmission(min(nl, 0.0), at.own.diffuse_transmission);
    vec3 scattered = 3.14159265 * (at.base * before + at.own.diffuse_transmission_color * passing_share(at) * behind);
#endif
#if !TRANSMISSION
    return scattered;
#else
    float roughness = through_roughness(at);
    float lobe = 3.14159265 * max(-nl, 0.0) * btdf_thin(at.normal, l, at.view, roughness * roughness);
    return mix(scattered, at.base * passing_share(at) * lobe, at.own.transmission);
#endif
}
#endif

#if SHEEN
/// The light with a sheen over it.
vec3 sheen_over(Layered at, vec3 light, float nl, HalfWay half_, float strength) {
    float alpha = at.own.sheen_roughness * at.own.sheen_roughness;
    float nh = (nl + at.facets.toward) * inversesqrt(max(half_.size2, 1e-30));
    float lobe = d_charlie(nh, alpha) * v_neubelt(nl, at.nv);
    float scale = sheen_scale(at.own.sheen_color, at.sheen_view, sheen_albedo(abs(nl), alpha));
    return at.own.sheen_color * (strength * 3.14159265 * max(nl, 0.0) * lobe) + light * scale;
}
#endif

/// The layers over the light `below` that the dielectric scatters: the `lobe` of the base, whose light comes
/// from `half` of the way, the sheen, and the coat, which takes its light from `l`.
vec3 layers_over(
    Layered at,
    vec3 below,
    vec3 l,
    float nl,
    HalfWay half_,
    float lobe,
    HalfWay coat_half,
    float strength,
    float coat_gain
) {
    float left = 1.0 - at.taken.x - at.taken.y * half_.rim;
    vec3 light = at.scattering * below * left + (at.reflecting + at.rising * half_.rim) * lobe;
#if SHEEN
    light = sheen_over(at, light, nl, half_, strength);
#endif
#if !CLEARCOAT
    return light;
#else
    float coat = coat_gain * facets(at.coat_facets, dot(at.coat_normal, l), coat_half);
    return coat_mix(light, vec3(coat), 1.0, at.coat_share);
#endif
}

/// The light of a lamp of colour 1 in the direction `l` that leaves the surface towards the viewer.
/// `strength` is a factor on the highlights.
vec3 layered_light(Layered at, vec3 l, float strength) {
#if TRANSMISSION || DIFFUSE_TRANSMISSION
    // Only what passes the surface has a use for light from behind.
    float nl = dot(at.normal, l);
#else
    float nl = clamp(dot(at.normal, l), 0.0, 1.0);
#endif
#if TRANSMISSION || DIFFUSE_TRANSMISSION
    // A facet that light passes mirrors it from the viewer's side.
    HalfWay half_ = half_way(l - at.normal * (2.0 * min(nl, 0.0)), at.view);
#else
    HalfWay half_ = half_way(l, at.view);
#endif
#if ANISOTROPY
    float lobe = strength * brushed_facets(at, l, nl, half_);
#else
    float lobe = strength * facets(at.facets, nl, half_);
#endif
    return layers_over(at, below_light(at, l, nl), l, nl, half_, lobe, half_, strength, strength * at.coat_gain);
}

#if AREA == AREA_SPHERE || AREA == AREA_TUBE
/// The light of a lamp of colour 1 with an area, of which `fallen` falls onto the surface, and which
/// the base and the coat see in highlights. `strength` is a factor on these.
vec3 layered_area_light(Layered at, float fallen, Seen base, Seen coat, float strength) {
    float nl = dot(at.normal, base.l);
    HalfWay half_ = half_way(base.l, at.view);
    float lobe = strength * base.gain * facets(at.facets, nl, half_);
    HalfWay coat_half = half_way(coat.l, at.view);
    return layers_over(at, vec3(fallen), coat.l, nl, half_, lobe, coat_half, strength, strength * coat.gain * at.coat_gain);
}
#endif

/// The layers over the light from around: what the base reflects of it, and what of the light that the
/// dielectric scatters is taken.
vec3 around_over(Layered at, Around around, vec3 emission, vec3 reflected, float taken) {
    vec3 below = at.scattering * around.front;
#if TRANSMISSION || DIFFUSE_TRANSMISSION
    below *= at.base;
#endif
#if DIFFUSE_TRANSMISSION
    vec3 behind = at.scattering * at.own.diffuse_transmission_color * passing_share(at) * around.back;
    below = mix(below, behind, at.own.diffuse_transmission);
#endif
#if TRANSMISSION
    below = mix(below, at.scattering * at.base * passing_share(at) * around.through, at.own.transmission);
#endif
    vec3 light = reflected + below * (1.0 - taken);
#if SHEEN
    float scale = sheen_scale(at.own.sheen_color, at.sheen_view, 0.0);
    light = at.own.sheen_color * at.sheen_view * around.front + light * scale;
#endif
    light += emission * layers.emissive_strength;
#if CLEARCOAT
    return coat_mix(light, around.coated, 1.0, at.coat_share);
#else
    return light;
#endif
}

/// The light from around that leaves the surface towards the viewer, with what it gives off itself.
vec3 layered_ambient(Layered at, Around around, vec3 emission) {
    SplitSum dielectric = split_sum_multi(at.f0, mean_reflectance(at, at.f0), at.dfg);
    SplitSum metal = split_sum_multi(at.base, mean_reflectance(at, at.base), at.dfg);
    float taken = at.own.specular * largest_channel(dielectric.single + dielectric.multiple);
    float weight = (1.0 - at.own.metallic) * at.own.specular;
    vec3 once = dielectric.single * weight + metal.single * at.own.metallic;
    vec3 several = dielectric.multiple * weight + metal.multiple * at.own.metallic;
    return around_over(at, around, emission, once * around.mirrored + several * around.front, taken);
}

/// The same where light comes evenly from everywhere: all lobes see the same light, so the mean over all
/// directions of their reflectance is enough.
vec3 layered_even(Layered at, vec3 light, vec3 emission) {
    float weight = (1.0 - at.own.metallic) * at.own.specular + at.own.metallic;
    // The mean of Schlick's approximation, as of `f_average_schlick`, whose other end is the weight.
    vec3 reflectance = at.blend * 0.952380952 + weight * 0.047619048;
#if IRIDESCENCE
    // A film does not reflect more towards the horizon than it does at the viewer's angle.
    reflectance = mix(reflectance, at.film * weight, at.own.iridescence);
#endif
    float taken = at.taken.x + at.taken.y * 0.047619048;
    return around_over(at, Around(light, light, light, light, light), emission, reflectance * light, taken);
}

/// The direction that the base mirrors towards the viewer.
vec3 mirrored_direction(Layered at) {
#if ANISOTROPY
    return bent_reflection(at.view, at.normal, at.bitangent, at.own.anisotropy, at.roughness);
#else
    return reflect(-at.view, at.normal);
#endif
}

#if TRANSMISSION
/// The directions that are seen through the surface in red, green and blue: columns of a matrix. A
/// thin surface does not bend light. With `volume`, a thickness of 0 is a thin surface
/// (KHR_materials_volume).
mat3 through_directions(Layered at) {
#if VOLUME
    if (!(at.own.thickness > 0.0)) {
        return mat3(-at.view, -at.view, -at.view);
    }
#endif
#if !VOLUME
    return mat3(-at.view, -at.view, -at.view);
#elif DISPERSION
    vec3 indices = dispersion_ior(layers.ior, layers.dispersion);
    return mat3(
        refract_exit(at.view, at.normal, indices.x, 1.0),
        refract_exit(at.view, at.normal, indices.y, 1.0),
        refract_exit(at.view, at.normal, indices.z, 1.0)
    );
#else
    vec3 bent = refract_exit(at.view, at.normal, layers.ior, 1.0);
    return mat3(bent, bent, bent);
#endif
}
#endif

#endif
