//! Materials of glTF as those of the programs.

use glam::DVec3;

use super::Reader;
use super::layers::read_layers;
use crate::scene::Layers;
use crate::scene::sets::Material;

/// The colour of a surface, and what it does with light.
///
/// # Errors
/// A value of an extension that is none.
pub fn read_surface(
    reader: &mut Reader<'_>,
    material: &gltf::Material<'_>,
) -> Result<(DVec3, Material), String> {
    let own = material.pbr_metallic_roughness();
    let [red, green, blue, _] = own.base_color_factor().map(f64::from);
    let color = DVec3::new(red, green, blue);
    let layers = read_layers(reader, material)?;
    let metal = layers.metallic;
    let rough = f64::from(own.roughness_factor()).clamp(0.0, 1.0);
    left_out(reader, material);
    let strength = f64::from(material.emissive_strength().unwrap_or(1.0)).max(0.0);
    let emission = DVec3::from_array(material.emissive_factor().map(f64::from)) * strength;
    if material.unlit() {
        if !reader.all_unlit && own.base_color_texture().is_some() {
            let what = "left out: textures of unlit materials beside lit ones";
            reader.notes.insert(what.to_owned());
        }
        return Ok(unlit_surface(reader.all_unlit, color));
    }
    let share = layers.specular_color * layers.specular;
    let normal = (((layers.ior - 1.0) / (layers.ior + 1.0)).powi(2) * share).min(DVec3::ONE);
    let specular = normal.lerp(color, metal);
    // Light of the surroundings is reflected by metals too, in their colour.
    let matt = DVec3::splat(1.0 - metal);
    let alpha = (rough * rough).max(1e-3);
    Ok((
        color,
        Material {
            emission,
            shininess: (2.0 / (alpha * alpha) - 2.0).clamp(1.0, 2000.0),
            ambient: DVec3::ONE,
            roughness: rough.max(0.045),
            diffuse: matt,
            specular,
            layers: Some(layers),
            ..Material::default()
        },
    ))
}

/// A surface that shows its colour and nothing else. If all are unlit, no lamp shines. Beside others,
/// a black surface gives the colour off.
fn unlit_surface(all_unlit: bool, color: DVec3) -> (DVec3, Material) {
    if all_unlit {
        return (color, Material::default());
    }
    let layers = Some(Layers { specular: 0.0, ..Layers::default() });
    (
        DVec3::ZERO,
        Material { emission: color, specular: DVec3::ZERO, layers, ..Material::default() },
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
