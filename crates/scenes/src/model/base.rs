//! The base of a material: metallic-roughness, or specular-glossiness as what has the same reflectance
//! and the same diffuse colour in it.

use glam::DVec3;
use gltf::texture::Info;

/// The factors and the textures of a material's base.
pub struct Base<'d> {
    /// With alpha.
    pub color: [f64; 4],
    pub color_texture: Option<Info<'d>>,
    pub metallic: f64,
    /// What its texture multiplies.
    pub roughness: f64,
    /// Its blue is metal, and its green roughness.
    pub surface_texture: Option<Info<'d>>,
    /// What it reflects, if KHR_materials_pbrSpecularGlossiness says so.
    pub gloss: Option<Gloss<'d>>,
}

/// KHR_materials_pbrSpecularGlossiness.
pub struct Gloss<'d> {
    /// What is reflected straight back.
    pub specular: DVec3,
    /// 1 for a mirror.
    pub factor: f64,
    /// Its colour is specular, and its alpha multiplies the factor.
    pub texture: Option<Info<'d>>,
}

impl<'d> Base<'d> {
    /// The base of a material. An unlit one has nothing but the colour (KHR_materials_unlit).
    pub fn of(material: &gltf::Material<'d>) -> Self {
        match material.pbr_specular_glossiness() {
            Some(own) if !material.unlit() => Self::of_gloss(&own),
            _ => Self::of_metal(&material.pbr_metallic_roughness()),
        }
    }

    fn of_metal(own: &gltf::material::PbrMetallicRoughness<'d>) -> Self {
        Self {
            color: own.base_color_factor().map(f64::from),
            color_texture: own.base_color_texture(),
            metallic: f64::from(own.metallic_factor()).clamp(0.0, 1.0),
            roughness: f64::from(own.roughness_factor()).clamp(0.0, 1.0),
            surface_texture: own.metallic_roughness_texture(),
            gloss: None,
        }
    }

    /// A dielectric with an index of refraction of 0 reflects the colour of KHR_materials_specular
    /// straight back, and scatters what the largest channel of that leaves (KHR_materials_ior).
    fn of_gloss(own: &gltf::material::PbrSpecularGlossiness<'d>) -> Self {
        let factor = f64::from(own.glossiness_factor()).clamp(0.0, 1.0);
        let texture = own.specular_glossiness_texture();
        let specular = DVec3::from_array(own.specular_factor().map(f64::from));
        Self {
            color: own.diffuse_factor().map(f64::from),
            color_texture: own.diffuse_texture(),
            metallic: 0.0,
            // The texture holds the roughness itself, which is no product with a factor.
            roughness: if texture.is_some() { 1.0 } else { 1.0 - factor },
            surface_texture: None,
            gloss: Some(Gloss { specular: specular.max(DVec3::ZERO), factor, texture }),
        }
    }
}
