//! Materials of glTF as those of the programs: the factors of the material and of its extensions,
//! which channels of its images are in which textures of `forward`, and where these are on the
//! surface: which set of coordinates they have, and how KHR_texture_transform moves, turns and
//! scales it. What the programs do not have is noted.

use crate::layers::Layers;
use crate::model::GltfReader;
use crate::sets::{Material, Object};
use glam::{DAffine2, DMat2, DVec2, DVec3, DVec4};
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
            let what = "ignored: textures of unlit materials, since other materials are lit";
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
        let note = "ignored, since no program supports it: transparency";
        reader.notes.insert(note.to_owned());
    }
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

/// The extensions that the parser does not know and that are read here. Any other unknown one is
/// noted as left out.
const READ: [&str; 6] = [
    "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",
    "KHR_materials_diffuse_transmission",
    "KHR_materials_dispersion",
    "KHR_materials_iridescence",
    "KHR_materials_sheen",
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
    let known = |name: &&String| !READ.contains(&name.as_str());
    for name in material.extensions().into_iter().flat_map(|all| all.keys()).filter(known) {
        reader.notes.insert(format!("ignored, since no program supports it: {name}"));
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
    let own = material.pbr_metallic_roughness();
    let mut layers =
        Layers { metallic: f64::from(own.metallic_factor()).clamp(0.0, 1.0), ..Layers::default() };
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

/// Channels of an image that go to the same channels of a texture of `forward`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct ImageChannels {
    /// The name of the texture's binding.
    pub map: &'static str,
    /// The number of the image in the document.
    pub image: usize,
    pub channels: &'static [usize],
    /// Whether the image is coded as sRGB.
    pub is_color: bool,
    pub coordinates: Coordinates,
    /// The bits of the strength of the image, an `f32`; see [`ImageChannels::scaled`].
    strength: u32,
}

const RGB: &[usize] = &[0, 1, 2];

/// A texture of an extension that the parser does not know: the extension, its field, the name of
/// the binding, the channels, and whether it is a colour.
type TextureField = (&'static str, &'static str, &'static str, &'static [usize], bool);

const FIELDS: [TextureField; 9] = [
    ("KHR_materials_anisotropy", "anisotropyTexture", "anisotropy_map", RGB, false),
    ("KHR_materials_clearcoat", "clearcoatTexture", "clearcoat_map", &[0], false),
    ("KHR_materials_clearcoat", "clearcoatRoughnessTexture", "clearcoat_map", &[1], false),
    (
        "KHR_materials_diffuse_transmission",
        "diffuseTransmissionColorTexture",
        "diffuse_transmission_map",
        RGB,
        true,
    ),
    (
        "KHR_materials_diffuse_transmission",
        "diffuseTransmissionTexture",
        "diffuse_transmission_map",
        &[3],
        false,
    ),
    ("KHR_materials_iridescence", "iridescenceTexture", "iridescence_map", &[0], false),
    ("KHR_materials_iridescence", "iridescenceThicknessTexture", "iridescence_map", &[1], false),
    ("KHR_materials_sheen", "sheenColorTexture", "sheen_map", RGB, true),
    ("KHR_materials_sheen", "sheenRoughnessTexture", "sheen_map", &[3], false),
];

/// Whether a field of an extension is a texture that is drawn.
fn is_drawn(extension: &str, field: &str) -> bool {
    FIELDS.iter().any(|known| (known.0, known.1) == (extension, field))
}

impl ImageChannels {
    fn new(map: &'static str, image: usize, channels: &'static [usize], is_color: bool) -> Self {
        let coordinates = Coordinates::default();
        Self { map, image, channels, is_color, coordinates, strength: 1_f32.to_bits() }
    }

    fn at(self, coordinates: Coordinates) -> Self {
        Self { coordinates, ..self }
    }

    /// A texel, mixed with 1: at strength 0 the result is 1, at strength 1 the texel. That of a normal
    /// map leans by a factor more, and is shortened if it does not fit into a texel.
    pub fn scaled(&self, texel: DVec4) -> DVec4 {
        let strength = f64::from(f32::from_bits(self.strength));
        if self.map != "normal_map" {
            return DVec4::ONE.lerp(texel, strength.clamp(0.0, 1.0));
        }
        let scaled = (2.0 * texel - 1.0) * DVec4::new(strength, strength, 1.0, 1.0);
        let scaled = scaled / scaled.truncate().abs().max_element().max(1.0);
        (0.5 * scaled + 0.5).with_w(texel.w)
    }
}

/// The parts of all textures of a material.
///
/// # Errors
/// A texture that is not there, with the place that names it.
pub fn material_parts(
    reader: &GltfReader<'_>,
    material: &gltf::Material<'_>,
) -> Result<Vec<ImageChannels>, String> {
    let mut parts = Vec::new();
    let own = material.pbr_metallic_roughness();
    let known = |info: &gltf::texture::Info<'_>, map, channels, is_color| {
        let part = ImageChannels::new(map, info.texture().source().index(), channels, is_color);
        part.at(Coordinates::of_texture(info))
    };
    let place = |field: &str| match material.index() {
        Some(index) => format!("materials[{index}].{field}"),
        None => field.to_owned(),
    };
    if let Some(info) = own.base_color_texture() {
        parts.push(known(&info, "base_map", RGB, true));
    }
    // An unlit material uses no other textures.
    if material.unlit() {
        return Ok(parts);
    }
    if let Some(info) = material.normal_texture() {
        let own = info.extension_value(TRANSFORM);
        let at = Coordinates::read(info.tex_coord(), own, &place("normalTexture"))?;
        let image = info.texture().source().index();
        let part = ImageChannels::new("normal_map", image, RGB, false).at(at);
        parts.push(ImageChannels { strength: info.scale().to_bits(), ..part });
    }
    for (info, map, channels, is_color) in factor_textures(material) {
        parts.push(known(&info, map, channels, is_color));
    }
    if let Some(info) = material.occlusion_texture() {
        let own = info.extension_value(TRANSFORM);
        let at = Coordinates::read(info.tex_coord(), own, &place("occlusionTexture"))?;
        let part =
            ImageChannels::new("occlusion_map", info.texture().source().index(), &[0], false)
                .at(at);
        parts.push(ImageChannels { strength: info.strength().to_bits(), ..part });
    }
    for field in &FIELDS {
        parts.extend(extension_part(reader, material, field)?);
    }
    Ok(parts)
}

/// A texture of a factor, the name of the binding, the channels, and whether it is a colour.
type FactorTexture<'d> = (gltf::texture::Info<'d>, &'static str, &'static [usize], bool);

/// The textures that multiply factors, of those that the parser knows.
fn factor_textures<'d>(material: &gltf::Material<'d>) -> Vec<FactorTexture<'d>> {
    let own = material.pbr_metallic_roughness();
    let (specular, volume) = (material.specular(), material.volume());
    let transmission = material.transmission().and_then(|own| own.transmission_texture());
    let weight = specular.as_ref().and_then(|own| own.specular_texture());
    let tint = specular.as_ref().and_then(|own| own.specular_color_texture());
    let found: [(_, _, &'static [usize], _); 6] = [
        (own.metallic_roughness_texture(), "metallic_roughness_map", &[1, 2], false),
        (material.emissive_texture(), "emission_map", RGB, true),
        (weight, "specular_map", &[3], false),
        (tint, "specular_map", RGB, true),
        (transmission, "transmission_map", &[0], false),
        (volume.and_then(|own| own.thickness_texture()), "transmission_map", &[1], false),
    ];
    let all = found.into_iter();
    all.filter_map(|(info, map, channels, is_color)| Some((info?, map, channels, is_color)))
        .collect()
}

/// The texture of an extension that the parser does not know, if the material has it.
fn extension_part(
    reader: &GltfReader<'_>,
    material: &gltf::Material<'_>,
    (extension, field, map, channels, is_color): &TextureField,
) -> Result<Option<ImageChannels>, String> {
    let value = material.extension_value(extension).and_then(|own| own.get(*field));
    let (Some(value), Some(index)) = (value, material.index()) else { return Ok(None) };
    let place = format!("materials[{index}].extensions.{extension}.{field}");
    let number = value.get("index").and_then(Value::as_u64);
    let number = number.ok_or_else(|| format!("{place}: expected a texture, found {value}"))?;
    let texture = usize::try_from(number).ok().and_then(|at| reader.document.textures().nth(at));
    let texture = texture.ok_or_else(|| format!("{place}: there is no texture {number}"))?;
    let set = set_of(value, &place)?.unwrap_or(0);
    let own = value.get("extensions").and_then(|all| all.get(TRANSFORM));
    let at = Coordinates::read(set, own, &place)?;
    Ok(Some(ImageChannels::new(map, texture.source().index(), channels, *is_color).at(at)))
}

/// The name of the extension.
const TRANSFORM: &str = "KHR_texture_transform";

/// The set of coordinates that a texture or its extension names, if it names one.
///
/// # Errors
/// It is not the number of a set.
fn set_of(value: &Value, place: &str) -> Result<Option<u32>, String> {
    let Some(named) = value.get("texCoord") else { return Ok(None) };
    let set = named.as_u64().and_then(|set| u32::try_from(set).ok());
    let wrong = || format!("{place}.texCoord: expected the number of a set, found {named}");
    set.map(Some).ok_or_else(wrong)
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub struct Coordinates {
    /// The set: `TEXCOORD_0` and so on.
    pub set: u32,
    /// The bits of the offset, the angle and the scale; `None` changes nothing.
    transform: Option<[u64; 5]>,
}

impl Coordinates {
    /// Those of a set, unchanged.
    pub fn of_set(set: u32) -> Self {
        Self { set, transform: None }
    }

    /// Those of a texture with a set of its own, and the value of the extension, if it has one.
    ///
    /// # Errors
    /// A value that is not valid, with its place.
    pub fn read(set: u32, extension: Option<&Value>, place: &str) -> Result<Self, String> {
        let Some(value) = extension else { return Ok(Self { set, transform: None }) };
        let place = format!("{place}.extensions.{TRANSFORM}");
        if !value.is_object() {
            return Err(format!("{place}: expected an object, found {value}"));
        }
        let wrong = |what: &str| format!("{place}.{what}");
        let pair = |key: &str, usual: f64| match value.get(key) {
            None => Ok([usual; 2]),
            Some(pair) => {
                let numbers = pair.as_array().map(|all| all.iter().map(Value::as_f64).collect());
                let numbers: Option<Vec<f64>> = numbers.unwrap_or_default();
                let numbers = numbers.and_then(|all| <[f64; 2]>::try_from(all).ok());
                numbers.ok_or_else(|| wrong(&format!("{key}: expected two numbers, found {pair}")))
            }
        };
        let ([x, y], [across, down]) = (pair("offset", 0.0)?, pair("scale", 1.0)?);
        let angle = match value.get("rotation") {
            None => 0.0,
            Some(angle) => angle
                .as_f64()
                .ok_or_else(|| wrong(&format!("rotation: expected a number, found {angle}")))?,
        };
        let set = set_of(value, &place)?.unwrap_or(set);
        Ok(Self { set, transform: Some([x, y, angle, across, down].map(f64::to_bits)) })
    }

    /// Those of a texture that the parser knows with its extension.
    pub fn of_texture(info: &gltf::texture::Info<'_>) -> Self {
        let Some(own) = info.texture_transform() else {
            return Self { set: info.tex_coord(), transform: None };
        };
        let ([x, y], [across, down]) = (own.offset(), own.scale());
        let numbers = [x, y, own.rotation(), across, down];
        Self {
            set: own.tex_coord().unwrap_or(info.tex_coord()),
            transform: Some(numbers.map(|number| f64::from(number).to_bits())),
        }
    }

    /// From the set to the texture. The angle is counter-clockwise as one looks at the image, whose
    /// second coordinate points down.
    pub fn texture_from_set(&self) -> DAffine2 {
        let Some(bits) = self.transform else { return DAffine2::IDENTITY };
        let [x, y, angle, across, down] = bits.map(f64::from_bits);
        let turned = DMat2::from_angle(-angle) * DMat2::from_diagonal(DVec2::new(across, down));
        DAffine2::from_mat2_translation(turned, DVec2::new(x, y))
    }
}

/// Coordinates that are this close to the edge of an image are meant to be at the edge.
const ROUNDING: f64 = 1e-4;

/// The part of the coordinates that a cell of the sheet shows.
#[derive(Debug, Clone, Copy)]
pub struct Window {
    pub low: DVec2,
    pub size: DVec2,
}

impl Window {
    pub const UNIT: Self = Self { low: DVec2::ZERO, size: DVec2::ONE };

    /// The smallest window of whole repetitions around some coordinates.
    pub fn around(low: DVec2, high: DVec2) -> Self {
        /// With more repetitions, each would get too few texels.
        const MOST: f64 = 32.0;
        if !low.is_finite() || !high.is_finite() {
            return Self::UNIT;
        }
        let low = (low + ROUNDING).floor();
        let size = ((high - ROUNDING).ceil() - low).clamp(DVec2::ONE, DVec2::splat(MOST));
        Self { low, size }
    }

    /// Where in the window coordinates are, in [0, 1]; those beyond it are repeated.
    pub fn share(&self, at: DVec2) -> DVec2 {
        let share = (at - self.low) / self.size;
        let is_within = |x: f64| (-ROUNDING..=1.0 + ROUNDING).contains(&x);
        let within = |x: f64| if is_within(x) { x.clamp(0.0, 1.0) } else { x - x.floor() };
        DVec2::new(within(share.x), within(share.y))
    }

    /// The coordinates at a share of it.
    pub fn at(&self, share: DVec2) -> DVec2 {
        self.low + share * self.size
    }
}
