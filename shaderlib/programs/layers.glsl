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
#include "../math/safe.glsl"
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
    /// `anisotropy`: unit, along the brush.
    vec3 tangent;
    vec3 bitangent;
    /// `anisotropy`: along the tangent and the bitangent.
    vec2 alphas;
    /// `clearcoat`: unit.
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
    zero.tangent = vec3(0.0);
    zero.bitangent = vec3(0.0);
    zero.alphas = vec2(0.0);
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
#if IRIDESCENCE
    // Schlick's form lets a film without thickness reflect at grazing angles, so it is left out, as in
    // Khronos Group's glTF Sample Renderer.
    at.own.iridescence = own.iridescence_thickness > 0.0 ? own.iridescence : 0.0;
#endif
#if SHEEN
    at.sheen_view = sheen_albedo(at.nv, at.own.sheen_roughness * at.own.sheen_roughness);
#endif
#if VOLUME
    at.passing = volume_transmittance(layers.attenuation_color, at.own.thickness, layers.attenuation_distance);
#endif
    return at;
}

#if ANISOTROPY
/// The surface, brushed along its tangent, which has the sign of the bitangent in `w`.
Layered brushed(Layered surface, vec4 tangent) {
    Layered at = surface;
    at.alphas = alpha_aniso(max(at.roughness * at.roughness, LEAST_ALPHA), at.own.anisotropy);
    // The isotropic surface whose facets are as wide.
    at.dfg = dfg_approx(at.nv, sqrt(sqrt(at.alphas.x * at.alphas.y)));
    vec3 along = safe_normalize(tangent.xyz - at.normal * dot(at.normal, tangent.xyz), vec3(0.0));
    vec3 across = cross(at.normal, along) * tangent.w;
    at.tangent = along * at.own.anisotropy_direction.x + across * at.own.anisotropy_direction.y;
    at.bitangent = cross(at.normal, at.tangent);
    return at;
}
#endif

#if CLEARCOAT
/// The surface with a coat, whose normal no texture bends.
Layered coated(Layered surface, vec3 coat_normal) {
    Layered at = surface;
    float cosine = seen_cosine(coat_normal, at.view);
    at.coat_normal = coat_normal;
    at.coat_share = at.own.clearcoat * f_schlick(vec3(0.04), 1.0, cosine).x;
    at.coat_gain = energy_compensation(vec3(1.0), dfg_approx(cosine, at.own.clearcoat_roughness)).x;
    return at;
}
#endif

/// Reflectance at the cosine `mu`, of a material that has `f0` at normal incidence.
vec3 reflectance(Layered at, vec3 f0, float mu) {
    vec3 plain = f_schlick(f0, 1.0, mu);
#if !IRIDESCENCE
    return plain;
#else
    vec3 film = iridescence(1.0, layers.iridescence_ior, f0, at.own.iridescence_thickness, mu);
    return mix(plain, film, at.own.iridescence);
#endif
}

/// The reflectance that the base's albedo is computed with: that of the film is towards the viewer.
vec3 mean_reflectance(Layered at, vec3 f0) {
#if !IRIDESCENCE
    return f0;
#else
    vec3 film = iridescence(1.0, layers.iridescence_ior, f0, at.own.iridescence_thickness, at.nv);
    return mix(f0, film, at.own.iridescence);
#endif
}

/// The largest channel.
float largest_channel(vec3 color) {
    return max(max(color.x, color.y), color.z);
}

/// The microfacets of a surface that reflects everything, times pi and n.l.
float facets(vec3 normal, vec3 view, vec3 l, vec3 h, float roughness) {
    float alpha = max(roughness * roughness, LEAST_ALPHA);
    vec3 n_cross_h = cross(normal, h);
    float nl = clamp(dot(normal, l), 0.0, 1.0);
    float nv = seen_cosine(normal, view);
    float d = d_ggx(clamp(dot(normal, h), 0.0, 1.0), dot(n_cross_h, n_cross_h), alpha);
    return 3.14159265 * nl * d * v_smith_ggx(nv, nl, alpha);
}

#if ANISOTROPY
/// The same for a brushed surface.
float brushed_facets(Layered at, vec3 l, vec3 h) {
    float nl = clamp(dot(at.normal, l), 0.0, 1.0);
    float nh = clamp(dot(at.normal, h), 0.0, 1.0);
    float d = d_ggx_aniso(dot(at.tangent, h), dot(at.bitangent, h), nh, at.alphas.x, at.alphas.y);
    return 3.14159265 * nl * d * v_smith_ggx_aniso(
        dot(at.tangent, at.view), dot(at.bitangent, at.view), at.nv,
        dot(at.tangent, l), dot(at.bitangent, l), nl, at.alphas.x, at.alphas.y
    );
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

/// What a dielectric does with the light of a lamp that it does not reflect.
vec3 below_light(Layered at, vec3 l) {
    float nl = dot(at.normal, l);
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

#if SHEEN
/// The light with a sheen over it.
vec3 sheen_over(Layered at, vec3 light, vec3 l, vec3 h, float strength) {
    float alpha = at.own.sheen_roughness * at.own.sheen_roughness;
    float nl = dot(at.normal, l);
    float lobe = d_charlie(dot(at.normal, h), alpha) * v_neubelt(nl, at.nv);
    float scale = sheen_scale(at.own.sheen_color, at.sheen_view, sheen_albedo(abs(nl), alpha));
    return at.own.sheen_color * (strength * 3.14159265 * max(nl, 0.0) * lobe) + light * scale;
}
#endif

/// The light of a lamp of colour 1 in the direction `l` that leaves the surface towards the viewer.
/// `strength` is a factor on the highlights.
vec3 layered_light(Layered at, vec3 l, float strength) {
    float nl = dot(at.normal, l);
    // A facet that light passes mirrors it from the viewer's side.
    vec3 h = safe_normalize(l - at.normal * (2.0 * min(nl, 0.0)) + at.view, at.normal);
    float mu = clamp(dot(at.view, h), 0.0, 1.0);
#if ANISOTROPY
    float lobe = strength * brushed_facets(at, l, h);
#else
    float lobe = strength * facets(at.normal, at.view, l, h, at.roughness);
#endif
    vec3 dielectric = at.own.specular * reflectance(at, at.f0, mu);
    vec3 below = below_light(at, l) * (1.0 - largest_channel(dielectric));
    vec3 of_dielectric = below + dielectric * energy_compensation(at.f0, at.dfg) * lobe;
    vec3 of_metal = reflectance(at, at.base, mu) * energy_compensation(at.base, at.dfg) * lobe;
    vec3 light = mix(of_dielectric, of_metal, at.own.metallic);
#if SHEEN
    light = sheen_over(at, light, l, h, strength);
#endif
#if !CLEARCOAT
    return light;
#else
    vec3 half_way = safe_normalize(l + at.view, at.coat_normal);
    float coat = strength * at.coat_gain * facets(at.coat_normal, at.view, l, half_way, at.own.clearcoat_roughness);
    return coat_mix(light, vec3(coat), 1.0, at.coat_share);
#endif
}

#if AREA == AREA_SPHERE || AREA == AREA_TUBE
/// The light of a lamp of colour 1 with an area, of which `fallen` falls onto the surface, and which
/// the base and the coat see in highlights. `strength` is a factor on these.
vec3 layered_area_light(Layered at, float fallen, Seen base, Seen coat, float strength) {
    vec3 h = safe_normalize(base.l + at.view, at.normal);
    float mu = clamp(dot(at.view, h), 0.0, 1.0);
    float lobe = strength * base.gain * facets(at.normal, at.view, base.l, h, at.roughness);
    vec3 dielectric = at.own.specular * reflectance(at, at.f0, mu);
    vec3 below = at.base * (fallen * (1.0 - largest_channel(dielectric)));
    vec3 of_dielectric = below + dielectric * energy_compensation(at.f0, at.dfg) * lobe;
    vec3 of_metal = reflectance(at, at.base, mu) * energy_compensation(at.base, at.dfg) * lobe;
    vec3 light = mix(of_dielectric, of_metal, at.own.metallic);
#if SHEEN
    light = sheen_over(at, light, base.l, h, strength);
#endif
#if !CLEARCOAT
    return light;
#else
    vec3 half_way = safe_normalize(coat.l + at.view, at.coat_normal);
    float lobe_of_coat = facets(at.coat_normal, at.view, coat.l, half_way, at.own.clearcoat_roughness);
    return coat_mix(light, vec3(strength * coat.gain * at.coat_gain * lobe_of_coat), 1.0, at.coat_share);
#endif
}
#endif

/// The light from around that leaves the surface towards the viewer, with what it gives off itself.
vec3 layered_ambient(Layered at, Around around, vec3 emission) {
    SplitSum dielectric = split_sum_multi(at.f0, mean_reflectance(at, at.f0), at.dfg);
    SplitSum metal = split_sum_multi(at.base, mean_reflectance(at, at.base), at.dfg);
    vec3 below = at.base * around.front;
#if DIFFUSE_TRANSMISSION
    vec3 behind = at.own.diffuse_transmission_color * passing_share(at) * around.back;
    below = mix(below, behind, at.own.diffuse_transmission);
#endif
#if TRANSMISSION
    below = mix(below, at.base * passing_share(at) * around.through, at.own.transmission);
#endif
    float taken = at.own.specular * largest_channel(dielectric.single + dielectric.multiple);
    vec3 of_dielectric = at.own.specular * (dielectric.single * around.mirrored + dielectric.multiple * around.front);
    vec3 of_metal = metal.single * around.mirrored + metal.multiple * around.front;
    vec3 light = mix(of_dielectric + below * (1.0 - taken), of_metal, at.own.metallic);
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
