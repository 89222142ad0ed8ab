//! Materials of glTF as those of the programs.

use glam::DVec3;

use super::GltfReader;
use super::layers::read_layers;
use crate::Layers;
use crate::sets::Material;

/// The colour of a surface, its material, and the means of its textures, which [`Means::apply`]
/// multiplies into the material.
///
/// # Errors
/// A value of an extension that is not valid.
pub fn read_surface(
    reader: &mut GltfReader<'_>,
    material: &gltf::Material<'_>,
) -> Result<(DVec3, Material, Means), String> {
    let own = material.pbr_metallic_roughness();
    let [red, green, blue, _] = own.base_color_factor().map(f64::from);
    let color = DVec3::new(red, green, blue);
    let layers = read_layers(reader, material)?;
    left_out(reader, material);
    let means = if material.unlit() { Means::default() } else { texture_means(reader, material)? };
    // Diffuse, specular and shininess are for permutations without glTF's material model. These
    // have no textures of metalness and roughness, so the means are multiplied in here.
    let metal = layers.metallic * means.metal;
    let factor = f64::from(own.roughness_factor()).clamp(0.0, 1.0);
    let rough = factor * means.rough;
    let strength = f64::from(material.emissive_strength().unwrap_or(1.0)).max(0.0);
    let emission = DVec3::from_array(material.emissive_factor().map(f64::from)) * strength;
    if material.unlit() {
        if !reader.all_unlit && own.base_color_texture().is_some() {
            let what = "left out: textures of unlit materials beside lit ones";
            reader.notes.insert(what.to_owned());
        }
        let (color, material) = unlit_surface(reader.all_unlit, color);
        return Ok((color, material, means));
    }
    let share = layers.specular_color * layers.specular;
    let normal = (((layers.ior - 1.0) / (layers.ior + 1.0)).powi(2) * share).min(DVec3::ONE);
    let specular = normal.lerp(color, metal);
    // Metals reflect no light diffusely. Ambient light they do reflect, in their colour.
    let matt = DVec3::splat(1.0 - metal);
    let alpha = (rough * rough).max(1e-3);
    Ok((
        color,
        Material {
            emission,
            shininess: (2.0 / (alpha * alpha) - 2.0).clamp(1.0, 2000.0),
            roughness: factor.max(0.045),
            diffuse: matt,
            specular,
            layers: Some(layers),
            ..Material::default()
        },
        means,
    ))
}

impl Means {
    /// Multiplies the means of textures that a permutation does not have into a material.
    pub fn apply(&self, material: &mut Material, lacks: Lacks) {
        if lacks.occlusion {
            material.ambient *= self.open;
        }
        if lacks.maps {
            material.emission *= self.emission;
            material.roughness = (material.roughness * self.rough).max(0.045);
            if let Some(layers) = &mut material.layers {
                layers.metallic *= self.metal;
            }
        }
    }
}

/// The textures that a permutation does not have: those of `material_maps` and of `occlusion=map`.
#[derive(Debug, Clone, Copy)]
pub struct Lacks {
    pub maps: bool,
    pub occlusion: bool,
}

/// A surface that shows its colour and nothing else. If all are unlit, no lamp shines. Beside lit
/// ones, it is a black surface that emits its colour.
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

/// Means of textures, as factors for permutations that do not have them.
#[derive(Debug, Clone, Copy)]
pub struct Means {
    metal: f64,
    rough: f64,
    /// From the occlusion: the share of the ambient light that arrives.
    open: f64,
    emission: DVec3,
}

impl Default for Means {
    fn default() -> Self {
        Self { metal: 1.0, rough: 1.0, open: 1.0, emission: DVec3::ONE }
    }
}

/// The means of a material's textures. Without them, a metallic factor of 1 that a texture lowers
/// everywhere would make the whole surface metal.
fn texture_means(
    reader: &mut GltfReader<'_>,
    material: &gltf::Material<'_>,
) -> Result<Means, String> {
    let mut means = Means::default();
    if let Some(info) = material.pbr_metallic_roughness().metallic_roughness_texture() {
        let mean = reader.texture_mean(&info.texture(), false)?;
        (means.rough, means.metal) = (mean.y, mean.z);
    }
    if let Some(occlusion) = material.occlusion_texture() {
        let mean = reader.texture_mean(&occlusion.texture(), false)?;
        let strength = f64::from(occlusion.strength()).clamp(0.0, 1.0);
        means.open = 1.0 + strength * (mean.x - 1.0);
    }
    // Without a factor nothing is emitted, whatever the texture is.
    if let Some(info) = material.emissive_texture() {
        means.emission = reader.texture_mean(&info.texture(), true)?;
    }
    Ok(means)
}

/// Notes on what the programs do not have.
fn left_out(reader: &mut GltfReader<'_>, material: &gltf::Material<'_>) {
    if material.alpha_mode() != gltf::material::AlphaMode::Opaque {
        let note = "left out, since the programs do not have it: transparency";
        reader.notes.insert(note.to_owned());
    }
}
