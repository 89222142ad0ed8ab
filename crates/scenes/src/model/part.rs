//! Which channels of a material's images are in which textures of `forward`.

use glam::DVec4;
use serde_json::Value;

use super::GltfReader;
use super::coordinates::{Coordinates, TRANSFORM, set_of};

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
    /// The bits of the strength of the image, an `f32`; see [`ImageChannels::weakened`].
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
pub fn is_drawn(extension: &str, field: &str) -> bool {
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

    /// A texel, mixed with 1: at strength 0 the result is 1, at strength 1 the texel.
    pub fn weakened(&self, texel: DVec4) -> DVec4 {
        DVec4::ONE.lerp(texel, f32::from_bits(self.strength).clamp(0.0, 1.0).into())
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
        parts.push(ImageChannels::new("normal_map", image, RGB, false).at(at));
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
