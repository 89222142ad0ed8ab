//! The factors of a glTF material besides its colour, roughness and emission.

use glam::{DVec2, DVec3};

/// What the block `layers` of `forward` holds. The default is a dielectric without extensions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Layers {
    /// Share of metal, [0, 1].
    pub metallic: f64,
    /// Index of refraction of the dielectric.
    pub ior: f64,
    /// Weight of the dielectric's reflection, [0, 1].
    pub specular: f64,
    /// Linear tint of the dielectric's reflectance at normal incidence.
    pub specular_color: DVec3,
    /// Factor on the emission.
    pub emissive_strength: f64,
    /// Strength of the coat, [0, 1].
    pub clearcoat: f64,
    /// Perceptual roughness of the coat, [0, 1].
    pub clearcoat_roughness: f64,
    /// Linear colour of the sheen.
    pub sheen_color: DVec3,
    /// Perceptual roughness of the sheen, [0, 1].
    pub sheen_roughness: f64,
    /// Strength of the anisotropy, [0, 1].
    pub anisotropy: f64,
    /// Cosine and sine of the rotation from the tangent towards the bitangent.
    pub anisotropy_direction: DVec2,
    /// Strength of the film, [0, 1].
    pub iridescence: f64,
    /// Index of refraction of the film.
    pub iridescence_ior: f64,
    /// Thickness of the film, nanometres.
    pub iridescence_thickness: f64,
    /// Thickness of the film where its texture is 0, nanometres.
    pub iridescence_least: f64,
    /// Share of the light that passes the surface, [0, 1].
    pub transmission: f64,
    /// How far light goes through the body, scene units.
    pub thickness: f64,
    /// Linear colour that white light has after `attenuation_distance`.
    pub attenuation_color: DVec3,
    /// The distance of that colour, scene units; 0 for a volume that absorbs nothing.
    pub attenuation_distance: f64,
    /// 20 over the Abbe number.
    pub dispersion: f64,
    /// Share of the scattered light that leaves on the other side, [0, 1].
    pub diffuse_transmission: f64,
    /// Linear colour of that light.
    pub diffuse_transmission_color: DVec3,
}

impl Default for Layers {
    fn default() -> Self {
        Self {
            metallic: 0.0,
            ior: 1.5,
            specular: 1.0,
            specular_color: DVec3::ONE,
            emissive_strength: 1.0,
            clearcoat: 0.0,
            clearcoat_roughness: 0.0,
            sheen_color: DVec3::ZERO,
            sheen_roughness: 0.0,
            anisotropy: 0.0,
            anisotropy_direction: DVec2::X,
            iridescence: 0.0,
            iridescence_ior: 1.3,
            iridescence_thickness: 400.0,
            iridescence_least: 100.0,
            transmission: 0.0,
            thickness: 0.0,
            attenuation_color: DVec3::ONE,
            attenuation_distance: 0.0,
            dispersion: 0.0,
            diffuse_transmission: 0.0,
            diffuse_transmission_color: DVec3::ONE,
        }
    }
}

impl Layers {
    /// The numbers of a field of the block; `None` for a name that it does not have.
    pub fn number(&self, field: &str) -> Option<Vec<f64>> {
        let vector = |value: DVec3| value.to_array().to_vec();
        Some(match field {
            "metallic" => vec![self.metallic],
            "ior" => vec![self.ior],
            "specular" => vec![self.specular],
            "specular_color" => vector(self.specular_color),
            "emissive_strength" => vec![self.emissive_strength],
            "clearcoat" => vec![self.clearcoat],
            "clearcoat_roughness" => vec![self.clearcoat_roughness],
            "sheen_color" => vector(self.sheen_color),
            "sheen_roughness" => vec![self.sheen_roughness],
            "anisotropy" => vec![self.anisotropy],
            "anisotropy_direction" => self.anisotropy_direction.to_array().to_vec(),
            "iridescence" => vec![self.iridescence],
            "iridescence_ior" => vec![self.iridescence_ior],
            "iridescence_thickness" => vec![self.iridescence_thickness],
            "iridescence_least" => vec![self.iridescence_least],
            "transmission" => vec![self.transmission],
            "thickness" => vec![self.thickness],
            "attenuation_color" => vector(self.attenuation_color),
            "attenuation_distance" => vec![self.attenuation_distance],
            "dispersion" => vec![self.dispersion],
            "diffuse_transmission" => vec![self.diffuse_transmission],
            "diffuse_transmission_color" => vector(self.diffuse_transmission_color),
            _ => return None,
        })
    }
}
