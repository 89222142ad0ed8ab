//! Which channels of a material's images are in which textures of `forward`, and where these are on
//! the surface: which set of coordinates they have, and how KHR_texture_transform moves, turns and
//! scales it.

use crate::model::GltfReader;
use crate::model::base::Base;
use crate::model::surface::has_alpha;
use glam::{DAffine2, DMat2, DVec2, DVec4};
use gltf::texture::{MagFilter, WrappingMode};
use serde_json::Value;

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
    /// What the image shows beyond its edges, across and down.
    pub wraps: [Wrap; 2],
    /// Whether an enlarged image shows its pixels as squares, instead of what is between them.
    pub is_blocky: bool,
    /// The bits of the strength of the image, an `f32`; see [`ImageChannels::scaled`].
    strength: u32,
    /// Whether the channels have the roughness of the image's alpha, which is glossiness.
    is_gloss: bool,
}

/// What an image shows beyond one of its edges.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Wrap {
    Repeat,
    Mirror,
    Clamp,
}

impl Wrap {
    fn of(mode: WrappingMode) -> Self {
        match mode {
            WrappingMode::Repeat => Self::Repeat,
            WrappingMode::MirroredRepeat => Self::Mirror,
            WrappingMode::ClampToEdge => Self::Clamp,
        }
    }

    /// The pixel of an image of `count` pixels that is shown at a place in its row, which may be
    /// beyond the image.
    pub fn pixel(self, at: i64, count: usize) -> usize {
        let count = i64::try_from(count).unwrap_or(i64::MAX).clamp(1, i64::MAX / 2);
        let found = match self {
            Self::Repeat => at.rem_euclid(count),
            Self::Clamp => at.clamp(0, count - 1),
            Self::Mirror => {
                let place = at.rem_euclid(2 * count);
                place.min(2 * count - 1 - place)
            }
        };
        usize::try_from(found).unwrap_or_default()
    }
}

const RGB: &[usize] = &[0, 1, 2];
const RGBA: &[usize] = &[0, 1, 2, 3];

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

/// The number of a texture's image: the one of EXT_texture_webp, if there is one.
pub fn image_of(texture: &gltf::Texture<'_>) -> Option<usize> {
    let own = texture.extension_value("EXT_texture_webp").and_then(|own| own.get("source"));
    let own = own.and_then(Value::as_u64).and_then(|index| usize::try_from(index).ok());
    own.or_else(|| texture.source().map(|image| image.index()))
}

/// Whether a field of an extension is a texture that is drawn.
pub fn is_drawn(extension: &str, field: &str) -> bool {
    FIELDS.iter().any(|known| (known.0, known.1) == (extension, field))
}

impl ImageChannels {
    /// `None` if the texture has no image that is read.
    fn new(
        map: &'static str,
        texture: &gltf::Texture<'_>,
        channels: &'static [usize],
        is_color: bool,
    ) -> Option<Self> {
        let sampler = texture.sampler();
        Some(Self {
            map,
            image: image_of(texture)?,
            channels,
            is_color,
            coordinates: Coordinates::default(),
            wraps: [sampler.wrap_s(), sampler.wrap_t()].map(Wrap::of),
            is_blocky: sampler.mag_filter() == Some(MagFilter::Nearest),
            strength: 1_f32.to_bits(),
            is_gloss: false,
        })
    }

    fn at(self, coordinates: Coordinates) -> Self {
        Self { coordinates, ..self }
    }

    fn with_strength(self, strength: f32) -> Self {
        Self { strength: strength.to_bits(), ..self }
    }

    /// A texel, mixed with 1: at strength 0 the result is 1, at strength 1 the texel. That of a normal
    /// map leans by a factor more, and is shortened if it does not fit into a texel.
    pub fn scaled(&self, texel: DVec4) -> DVec4 {
        let strength = f64::from(f32::from_bits(self.strength));
        if self.is_gloss {
            return DVec4::splat((1.0 - strength * texel.w).clamp(0.0, 1.0));
        }
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
    let place = |field: &str| match material.index() {
        Some(index) => format!("materials[{index}].{field}"),
        None => field.to_owned(),
    };
    parts.extend(color_parts(reader, material));
    // An unlit material uses no other textures.
    if material.unlit() {
        return Ok(parts);
    }
    if let Some(info) = material.normal_texture() {
        let own = info.extension_value(TRANSFORM);
        let at = Coordinates::read(info.tex_coord(), own, &place("normalTexture"))?;
        let part = ImageChannels::new("normal_map", &info.texture(), RGB, false);
        parts.extend(part.map(|part| part.at(at).with_strength(info.scale())));
    }
    for (info, map, channels, is_color) in factor_textures(material) {
        parts.extend(known_part(&info, map, channels, is_color));
    }
    parts.extend(gloss_parts(material));
    if let Some(info) = material.occlusion_texture() {
        let own = info.extension_value(TRANSFORM);
        let at = Coordinates::read(info.tex_coord(), own, &place("occlusionTexture"))?;
        let part = ImageChannels::new("occlusion_map", &info.texture(), &[0], false);
        parts.extend(part.map(|part| part.at(at).with_strength(info.strength())));
    }
    for field in &FIELDS {
        parts.extend(extension_part(reader, material, field)?);
    }
    Ok(parts)
}

/// The part of a texture that the parser knows, if it has an image.
fn known_part(
    info: &gltf::texture::Info<'_>,
    map: &'static str,
    channels: &'static [usize],
    is_color: bool,
) -> Option<ImageChannels> {
    let part = ImageChannels::new(map, &info.texture(), channels, is_color)?;
    Some(part.at(Coordinates::of_texture(info)))
}

/// The parts of the texture of a material's base colour.
fn color_parts(reader: &GltfReader<'_>, material: &gltf::Material<'_>) -> Vec<ImageChannels> {
    let info = Base::of(material).color_texture;
    let part = |map, channels: &'static [usize]| {
        info.as_ref().and_then(|info| known_part(info, map, channels, true))
    };
    // An unlit surface beside lit ones emits its colour.
    let is_emitted = material.unlit() && !reader.all_unlit;
    // The alpha of opaque materials counts for nothing.
    let parts = match (is_emitted, has_alpha(material)) {
        (false, false) => [part("base_map", RGB), None],
        (false, true) => [part("base_map", RGBA), None],
        (true, false) => [part("emission_map", RGB), None],
        (true, true) => [part("emission_map", RGB), part("base_map", &[3])],
    };
    parts.into_iter().flatten().collect()
}

/// The parts of the texture of specular-glossiness: what is reflected, and the roughness.
fn gloss_parts(material: &gltf::Material<'_>) -> Vec<ImageChannels> {
    let Some(gloss) = Base::of(material).gloss else { return Vec::new() };
    let Some(info) = gloss.texture else { return Vec::new() };
    let rough = known_part(&info, "metallic_roughness_map", &[1], false);
    let rough = rough.map(|part| part.with_strength(gloss.factor as f32));
    let rough = rough.map(|part| ImageChannels { is_gloss: true, ..part });
    known_part(&info, "specular_map", RGB, true).into_iter().chain(rough).collect()
}

/// A texture of a factor, the name of the binding, the channels, and whether it is a colour.
type FactorTexture<'d> = (gltf::texture::Info<'d>, &'static str, &'static [usize], bool);

/// The textures that multiply factors, of those that the parser knows.
fn factor_textures<'d>(material: &gltf::Material<'d>) -> Vec<FactorTexture<'d>> {
    let own = Base::of(material);
    let (specular, volume) = (material.specular(), material.volume());
    let transmission = material.transmission().and_then(|own| own.transmission_texture());
    // The factors of both would be multiplied, and the extension excludes the other.
    let specular = specular.filter(|_| own.gloss.is_none());
    let weight = specular.as_ref().and_then(|own| own.specular_texture());
    let tint = specular.as_ref().and_then(|own| own.specular_color_texture());
    let found: [(_, _, &'static [usize], _); 6] = [
        (own.surface_texture, "metallic_roughness_map", &[1, 2], false),
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
    Ok(ImageChannels::new(map, &texture, channels, *is_color).map(|part| part.at(at)))
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

#[cfg(test)]
mod tests {
    use super::Wrap;

    /// Pixels of an image of three, from two to its left: as OpenGL defines the modes of glTF
    /// (OpenGL 4.6, 8.14.2).
    #[test]
    fn modes_are_those_of_opengl() {
        let row = |wrap: Wrap| (-2..6).map(|at| wrap.pixel(at, 3)).collect::<Vec<_>>();
        assert_eq!(row(Wrap::Repeat), [1, 2, 0, 1, 2, 0, 1, 2]);
        assert_eq!(row(Wrap::Clamp), [0, 0, 0, 1, 2, 2, 2, 2]);
        assert_eq!(row(Wrap::Mirror), [1, 0, 0, 1, 2, 2, 1, 0]);
    }
}
