//! The block `Layers` of `forward`, also for programs that compute none of the layers.

#ifndef LAMPLIGHT_PROGRAMS_FORWARD_FACTORS_GLSL
#define LAMPLIGHT_PROGRAMS_FORWARD_FACTORS_GLSL

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
    /// `iridescence`: thickness of the film, nanometres.
    float iridescence_thickness;
    /// `transmission`: transmissionFactor, [0, 1].
    float transmission;
    /// `volume`: thicknessFactor, scene units.
    float thickness;
    /// `dispersion`: 20 over the Abbe number.
    float dispersion;
    /// `ambient=ibl`: levels of `sky_specular`, even in perceptual roughness; 1 where it has one.
    float sky_levels;
    /// `iridescence`, `material_maps`: thickness of the film where green is 0, nanometres.
    float iridescence_least;
} layers;

#endif
