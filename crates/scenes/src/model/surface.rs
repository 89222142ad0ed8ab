//! Materials of glTF as those of the programs: the factors of the material and of its extensions.
//! What the programs do not have is noted.

use crate::layers::Layers;
use crate::model::GltfReader;
use crate::model::base::Base;
use crate::model::channels::is_drawn;
use crate::model::document::{ignored_extension, is_read};
use crate::sets::{Material, Object};
use glam::{DVec2, DVec3};
use gltf::material::AlphaMode;
use serde_json::{Map, Value};

/// The colour of a surface, its material, and the means of its textures, which [`Means::apply`]
/// multiplies into the material.
///
/// # Errors
/// A value of an extension that is not valid.
pub fn read_surface(
    reader: &mut GltfReader<'_>,
    material: &gltf::Material<'_>,
) -> Result<(DVec3, Material, Means), String> {
    let own = Base::of(material);
    let [red, green, blue, _] = own.color;
    let color = DVec3::new(red, green, blue);
    let layers = read_layers(reader, material)?;
    left_out(reader, material);
    if layers.transmission > 0.0 && !material.unlit() {
        let note = "glass shows its surroundings alone: other objects are not seen through it";
        reader.notes.insert(note.to_owned());
    }
    let means = texture_means(reader, material)?;
    // Diffuse, specular and shininess are for permutations without glTF's material model. These
    // have no textures of metalness and roughness, so the means are multiplied in here.
    let metal = layers.metallic * means.metal;
    let factor = own.roughness;
    let rough = factor * means.rough;
    let strength = f64::from(material.emissive_strength().unwrap_or(1.0)).max(0.0);
    let emission = DVec3::from_array(material.emissive_factor().map(f64::from)) * strength;
    if material.unlit() {
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
    if material.unlit() {
        // Beside lit surfaces it emits its colour; alone it has a texture of colours.
        let emitted = Base::of(material).color_texture;
        if let Some(info) = emitted.filter(|_| !reader.all_unlit) {
            means.emission = reader.texture_mean(&info.texture(), true)?.truncate();
        }
        return Ok(means);
    }
    let base = Base::of(material);
    if let Some(info) = base.surface_texture {
        let mean = reader.texture_mean(&info.texture(), false)?;
        (means.rough, means.metal) = (mean.y, mean.z);
    }
    if let Some((gloss, info)) = base.gloss.and_then(|gloss| Some((gloss.factor, gloss.texture?))) {
        means.rough = 1.0 - gloss * reader.texture_mean(&info.texture(), false)?.w;
    }
    if let Some(occlusion) = material.occlusion_texture() {
        let mean = reader.texture_mean(&occlusion.texture(), false)?;
        let strength = f64::from(occlusion.strength()).clamp(0.0, 1.0);
        means.open = 1.0 + strength * (mean.x - 1.0);
    }
    // Without a factor nothing is emitted, whatever the texture is.
    if let Some(info) = material.emissive_texture() {
        means.emission = reader.texture_mean(&info.texture(), true)?.truncate();
    }
    Ok(means)
}

/// Notes on what the programs do not have.
fn left_out(reader: &mut GltfReader<'_>, material: &gltf::Material<'_>) {
    let note = match material.alpha_mode() {
        AlphaMode::Opaque => return,
        AlphaMode::Mask => "shadows are those of whole faces, without what their alpha leaves out",
        AlphaMode::Blend => "surfaces that are blended by alpha have no shadows",
    };
    reader.notes.insert(note.to_owned());
}

/// Whether points of a material are left out by their alpha. No alpha is below a threshold of 0.
pub fn is_masked(material: &gltf::Material<'_>) -> bool {
    material.alpha_mode() == AlphaMode::Mask && cutoff(material) > 0.0
}

fn cutoff(material: &gltf::Material<'_>) -> f64 {
    f64::from(material.alpha_cutoff().unwrap_or(0.5))
}

/// Whether highlights have a direction along the surface.
pub fn is_anisotropic(material: &gltf::Material<'_>) -> bool {
    material.extension_value("KHR_materials_anisotropy").is_some()
}

/// Whether alpha has a meaning. That of an opaque material is ignored.
pub fn has_alpha(material: &gltf::Material<'_>) -> bool {
    is_masked(material) || is_blended(material)
}

/// Whether a material is blended over what is behind it.
pub fn is_blended(material: &gltf::Material<'_>) -> bool {
    material.alpha_mode() == AlphaMode::Blend
}

/// The alpha of an object: that of a material that is blended, and for one that is masked such that a
/// product with its texture below one half is what the material leaves out (glTF 2.0, 3.9.4). Everything
/// else is opaque.
pub fn drawn_alpha(material: &gltf::Material<'_>) -> f64 {
    if is_blended(material) {
        return Base::of(material).color[3].clamp(0.0, 1.0);
    }
    if !is_masked(material) {
        return 1.0;
    }
    Base::of(material).color[3] * 0.5 / cutoff(material)
}

/// Axes of `forward`, and whether a material needs them.
type AxisNeed = (&'static str, fn(&Layers) -> bool);

const AXES: [AxisNeed; 8] = [
    ("clearcoat", |layers| layers.clearcoat > 0.0),
    ("sheen", |layers| layers.sheen_color != DVec3::ZERO),
    ("iridescence", |layers| layers.iridescence > 0.0),
    ("anisotropy", |layers| layers.anisotropy > 0.0),
    ("transmission", |layers| layers.transmission > 0.0),
    ("diffuse_transmission", |layers| layers.diffuse_transmission > 0.0),
    ("volume", has_body),
    ("dispersion", |layers| {
        layers.dispersion > 0.0 && layers.transmission > 0.0 && has_body(layers)
    }),
];

/// Whether light that is transmitted by the surface goes through a volume.
fn has_body(layers: &Layers) -> bool {
    layers.thickness > 0.0 && (layers.transmission > 0.0 || layers.diffuse_transmission > 0.0)
}

/// The values of axes that show the layers of some objects.
pub(crate) fn layer_axes(objects: &[Object]) -> Vec<String> {
    let is_needed = |needs: fn(&Layers) -> bool| {
        objects.iter().filter_map(|object| object.material.layers.as_ref()).any(needs)
    };
    let own = AXES.iter().filter(|(_, needs)| is_needed(*needs));
    let base = std::iter::once("metallic_roughness");
    base.chain(own.map(|(axis, _)| *axis)).map(|axis| format!("{axis}=true")).collect()
}

/// The layers of a material, apart from its colour, roughness and emission.
///
/// # Errors
/// A value that is not valid, with its place.
fn read_layers(
    reader: &mut GltfReader<'_>,
    material: &gltf::Material<'_>,
) -> Result<Layers, String> {
    let place = match material.index() {
        Some(index) => format!("materials[{index}]"),
        None => return Ok(Layers { metallic: 1.0, ..Layers::default() }),
    };
    let unknown = |name: &&String| !is_read(name);
    for name in material.extensions().into_iter().flat_map(|all| all.keys()).filter(unknown) {
        reader.notes.insert(ignored_extension(name));
    }
    let mut layers = parsed_layers(material, &place)?;
    let mut values =
        |name: &str| ExtensionValues::of(reader, material.extension_value(name), &place, name);
    if let Some(own) = values("KHR_materials_clearcoat")? {
        layers.clearcoat = own.share("clearcoatFactor", 0.0)?;
        layers.clearcoat_roughness = own.share("clearcoatRoughnessFactor", 0.0)?;
    }
    if let Some(own) = values("KHR_materials_sheen")? {
        layers.sheen_color = own.color("sheenColorFactor", DVec3::ZERO)?;
        layers.sheen_roughness = own.share("sheenRoughnessFactor", 0.0)?;
    }
    if let Some(own) = values("KHR_materials_anisotropy")? {
        layers.anisotropy = own.share("anisotropyStrength", 0.0)?;
        layers.anisotropy_direction =
            DVec2::from_angle(own.number("anisotropyRotation", 0.0, f64::MIN)?);
    }
    if let Some(own) = values("KHR_materials_iridescence")? {
        layers.iridescence = own.share("iridescenceFactor", 0.0)?;
        layers.iridescence_ior = own.number("iridescenceIor", 1.3, 1.0)?;
        layers.iridescence_least = own.number("iridescenceThicknessMinimum", 100.0, 0.0)?;
        // Without a texture the film is everywhere as thick as it can be.
        layers.iridescence_thickness = own.number("iridescenceThicknessMaximum", 400.0, 0.0)?;
    }
    if let Some(own) = values("KHR_materials_dispersion")? {
        layers.dispersion = own.number("dispersion", 0.0, 0.0)?;
    }
    if let Some(own) = values("KHR_materials_diffuse_transmission")? {
        layers.diffuse_transmission = own.share("diffuseTransmissionFactor", 0.0)?;
        layers.diffuse_transmission_color =
            own.color("diffuseTransmissionColorFactor", DVec3::ONE)?;
    }
    Ok(layers)
}

/// The factors that the parser gives.
fn parsed_layers(material: &gltf::Material<'_>, place: &str) -> Result<Layers, String> {
    let at = |name: &str| format!("{place}.extensions.{name}");
    let own = Base::of(material);
    let mut layers = Layers { metallic: own.metallic, ..Layers::default() };
    if let Some(gloss) = own.gloss {
        return Ok(Layers { ior: 0.0, specular_color: gloss.specular, ..layers });
    }
    if let Some(ior) = material.ior() {
        // 0 stands for full reflection. Any other value must be at least 1.
        let least = if ior == 0.0 { 0.0 } else { 1.0 };
        layers.ior = bounded(ior.into(), least, f64::MAX, &at("KHR_materials_ior.ior"))?;
    }
    if let Some(specular) = material.specular() {
        let name = "KHR_materials_specular";
        let factor = specular.specular_factor().into();
        layers.specular = bounded(factor, 0.0, 1.0, &at(&format!("{name}.specularFactor")))?;
        let color = specular.specular_color_factor();
        layers.specular_color = bounded_color(color, &at(&format!("{name}.specularColorFactor")))?;
    }
    if let Some(transmission) = material.transmission() {
        let name = "KHR_materials_transmission";
        let factor = transmission.transmission_factor().into();
        layers.transmission =
            bounded(factor, 0.0, 1.0, &at(&format!("{name}.transmissionFactor")))?;
    }
    volume_layers(material, place, &mut layers)?;
    Ok(layers)
}

/// The thickness and the attenuation of a volume.
fn volume_layers(
    material: &gltf::Material<'_>,
    place: &str,
    layers: &mut Layers,
) -> Result<(), String> {
    const NAME: &str = "KHR_materials_volume";
    let Some(volume) = material.volume() else { return Ok(()) };
    let at = |field: &str| format!("{place}.extensions.{NAME}.{field}");
    let thickness = volume.thickness_factor().into();
    layers.thickness = bounded(thickness, 0.0, f64::MAX, &at("thicknessFactor"))?;
    // Infinity is the default: nothing is absorbed.
    let distance = f64::from(volume.attenuation_distance());
    if distance != f64::INFINITY {
        let place = at("attenuationDistance");
        layers.attenuation_distance = bounded(distance, f64::MIN_POSITIVE, f64::MAX, &place)?;
    }
    layers.attenuation_color = bounded_color(volume.attenuation_color(), &at("attenuationColor"))?;
    Ok(())
}

/// A number between two bounds.
fn bounded(value: f64, least: f64, most: f64, place: &str) -> Result<f64, String> {
    if value.is_finite() && (least..=most).contains(&value) {
        return Ok(value);
    }
    let range = match (least, most) {
        (f64::MIN, _) => "a finite number".to_owned(),
        (f64::MIN_POSITIVE, _) => "a number above 0".to_owned(),
        (_, f64::MAX) => format!("a number of {least} or more"),
        _ => format!("a number from {least} to {most}"),
    };
    Err(format!("{place}: expected {range}, found {value}"))
}

fn bounded_color(color: [f32; 3], place: &str) -> Result<DVec3, String> {
    for channel in color {
        bounded(channel.into(), 0.0, f64::MAX, place)?;
    }
    Ok(DVec3::from_array(color.map(f64::from)))
}

/// The values of an extension that the parser does not know.
struct ExtensionValues<'v> {
    fields: &'v Map<String, Value>,
    place: String,
}

impl<'v> ExtensionValues<'v> {
    /// `None` if the material does not have the extension.
    fn of(
        reader: &mut GltfReader<'_>,
        value: Option<&'v Value>,
        place: &str,
        name: &str,
    ) -> Result<Option<Self>, String> {
        let place = format!("{place}.extensions.{name}");
        let Some(value) = value else { return Ok(None) };
        let fields = value.as_object();
        let fields = fields.ok_or_else(|| format!("{place}: expected an object, found {value}"))?;
        let left_out = |key: &&String| key.ends_with("Texture") && !is_drawn(name, key);
        for key in fields.keys().filter(left_out) {
            let note = format!("ignored, since no program supports it: {key} of {name}");
            reader.notes.insert(note);
        }
        Ok(Some(Self { fields, place }))
    }

    fn checked(&self, key: &str, usual: f64, least: f64, most: f64) -> Result<f64, String> {
        let place = format!("{}.{key}", self.place);
        let Some(value) = self.fields.get(key) else { return Ok(usual) };
        let number = value.as_f64();
        let number = number.ok_or_else(|| format!("{place}: expected a number, found {value}"))?;
        bounded(number, least, most, &place)
    }

    /// A number of at least `least`.
    fn number(&self, key: &str, usual: f64, least: f64) -> Result<f64, String> {
        self.checked(key, usual, least, f64::MAX)
    }

    /// A number from 0 to 1.
    fn share(&self, key: &str, usual: f64) -> Result<f64, String> {
        self.checked(key, usual, 0.0, 1.0)
    }

    fn color(&self, key: &str, usual: DVec3) -> Result<DVec3, String> {
        let place = format!("{}.{key}", self.place);
        let Some(value) = self.fields.get(key) else { return Ok(usual) };
        let numbers = value.as_array().map(|list| list.iter().map(Value::as_f64).collect());
        let numbers: Option<Vec<f64>> = numbers.unwrap_or_default();
        let Some([red, green, blue]) = numbers.and_then(|list| <[f64; 3]>::try_from(list).ok())
        else {
            return Err(format!("{place}: expected three numbers, found {value}"));
        };
        for channel in [red, green, blue] {
            bounded(channel, 0.0, f64::MAX, &place)?;
        }
        Ok(DVec3::new(red, green, blue))
    }
}
