//! Materials of glTF as those of the programs.

use glam::DVec3;

use super::Reader;
use crate::scene::sets::Material;

/// The colour of a surface, and what it does with light.
pub fn read_surface(reader: &mut Reader<'_>, material: &gltf::Material<'_>) -> (DVec3, Material) {
    let own = material.pbr_metallic_roughness();
    let [red, green, blue, _] = own.base_color_factor().map(f64::from);
    let color = DVec3::new(red, green, blue);
    let metal = f64::from(own.metallic_factor()).clamp(0.0, 1.0);
    let rough = f64::from(own.roughness_factor()).clamp(0.0, 1.0);
    left_out(reader, material);
    let strength = f64::from(material.emissive_strength().unwrap_or(1.0));
    let emission = DVec3::from_array(material.emissive_factor().map(f64::from)) * strength;
    if material.unlit() {
        let dark = Material { diffuse: DVec3::ZERO, ambient: DVec3::ZERO, ..Material::default() };
        return (color, Material { emission: color, specular: DVec3::ZERO, ..dark });
    }
    let ior = f64::from(material.ior().unwrap_or(1.5));
    let share = material.specular().map_or(DVec3::ONE, |specular| {
        let tint = DVec3::from_array(specular.specular_color_factor().map(f64::from));
        tint * f64::from(specular.specular_factor())
    });
    let normal = (((ior - 1.0) / (ior + 1.0)).powi(2) * share).min(DVec3::ONE);
    let specular = normal.lerp(color, metal);
    // Light of the surroundings is reflected by metals too, in their colour.
    let matt = DVec3::splat(1.0 - metal);
    let alpha = (rough * rough).max(1e-3);
    (
        color,
        Material {
            emission,
            shininess: (2.0 / (alpha * alpha) - 2.0).clamp(1.0, 2000.0),
            ambient: DVec3::ONE,
            roughness: rough.max(0.045),
            diffuse: matt,
            specular,
            ..Material::default()
        },
    )
}

/// Notes on what the programs do not have.
fn left_out(reader: &mut Reader<'_>, material: &gltf::Material<'_>) {
    let own = material.pbr_metallic_roughness();
    let absent = [
        (own.metallic_roughness_texture().is_some(), "textures of metal and roughness"),
        (material.occlusion_texture().is_some(), "textures of occlusion"),
        (material.emissive_texture().is_some(), "textures of emission"),
        (material.alpha_mode() != gltf::material::AlphaMode::Opaque, "transparency"),
    ];
    for (_, what) in absent.iter().filter(|(is_there, _)| *is_there) {
        reader.notes.insert(format!("left out, since the programs do not have them: {what}"));
    }
}
