//! What inputs are taken from: their names say it, or else their types and places.

use std::collections::BTreeMap;

use lamplight_bundle::Varying;

use super::shape::NumberType;
use super::words::{has_word, name_words};
use crate::sketch::input_label;

/// What a vertex has, or what can be computed of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Source {
    Position,
    Normal,
    Tangent,
    Bitangent,
    Uv,
    Color,
    /// From the point to the first light, not of unit length.
    ToLight,
    /// From the point to the viewer, not of unit length.
    ToEye,
    /// The unit vector between both.
    HalfWay,
    /// In view space.
    SeenPosition,
    /// In view space.
    SeenNormal,
    /// In the clip space of the first light.
    LightPosition,
    /// The distance before the viewer.
    Depth,
    Zero,
}

impl Source {
    /// In words, for the table.
    pub const fn text(self) -> &'static str {
        match self {
            Self::Position => "position",
            Self::Normal => "normal",
            Self::Tangent => "tangent",
            Self::Bitangent => "bitangent",
            Self::Uv => "uv",
            Self::Color => "colour",
            Self::ToLight => "to the light",
            Self::ToEye => "to the viewer",
            Self::HalfWay => "half-way vector",
            Self::SeenPosition => "position in view space",
            Self::SeenNormal => "normal in view space",
            Self::LightPosition => "position in the light's clip space",
            Self::Depth => "depth in view space",
            Self::Zero => "0",
        }
    }
}

const EYE: &[&str] = &["eye", "view", "viewer", "camera", "cam", "v"];
const LIGHT: &[&str] = &["light", "lamp", "sun", "l"];
const PLACE: &[&str] = &["position", "pos", "world", "p", "point", "vertex", "place", "space"];
const NORMAL: &[&str] = &["normal", "norm", "nrm", "n"];
const COLOR: &[&str] = &["color", "colour", "col", "albedo", "diffuse", "tint", "rgb"];

/// An input has the source if its name has a word of each list. The first line that fits counts.
const RULES: &[(&[&[&str]], Source)] = &[
    (&[&["half", "halfway", "h"]], Source::HalfWay),
    (&[&["bitangent", "binormal", "bitan"]], Source::Bitangent),
    (&[&["tangent", "tan", "tang"]], Source::Tangent),
    (&[EYE, NORMAL], Source::SeenNormal),
    (&[NORMAL], Source::Normal),
    (
        &[&["shadow", "light"], &["space", "clip", "coord", "coords", "shadow"]],
        Source::LightPosition,
    ),
    (&[&["light", "lamp"], COLOR], Source::Color),
    (&[LIGHT], Source::ToLight),
    (&[&["uv", "uvs", "st", "tex", "coord", "coords", "texture", "map"]], Source::Uv),
    (&[EYE, PLACE], Source::SeenPosition),
    (&[EYE], Source::ToEye),
    (&[COLOR], Source::Color),
    (&[&["depth"]], Source::Depth),
    (&[PLACE], Source::Position),
    (&[&["t"]], Source::Tangent),
    (&[&["b"]], Source::Bitangent),
];

/// Everything that an input can be taken from, by the words that name it.
pub const SOURCES: &[Source] = &[
    Source::Position,
    Source::Normal,
    Source::Tangent,
    Source::Bitangent,
    Source::Uv,
    Source::Color,
    Source::ToLight,
    Source::ToEye,
    Source::HalfWay,
    Source::SeenPosition,
    Source::SeenNormal,
    Source::LightPosition,
    Source::Depth,
    Source::Zero,
];

/// How a source was found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Hint {
    /// Somebody chose it.
    Chosen,
    Name,
    Type,
    Nothing,
}

/// The source of an input of a fragment stage, or of an attribute.
pub fn input_source(input: &Varying) -> (Source, Hint) {
    let ty = NumberType::of(&input.ty);
    if ty.is_integer {
        return (Source::Zero, Hint::Nothing);
    }
    let words = name_words(input.name.as_deref().unwrap_or_default());
    let fits = |groups: &&[&[&str]]| groups.iter().all(|group| has_word(&words, group));
    if let Some((_, source)) = RULES.iter().find(|(groups, _)| fits(groups)) {
        return (*source, Hint::Name);
    }
    match (ty.rows, input.location) {
        (2, _) => (Source::Uv, Hint::Type),
        (3 | 4, Some(0)) => (Source::Position, Hint::Type),
        _ => (Source::Zero, Hint::Nothing),
    }
}

/// The source that somebody chose for an input, or else the one that its name suggests.
pub fn chosen_source(input: &Varying, chosen: &BTreeMap<String, String>) -> (Source, Hint) {
    let name = chosen.get(&input_label(input));
    let found = SOURCES.iter().find(|source| Some(source.text()) == name.map(String::as_str));
    found.map_or_else(|| input_source(input), |source| (*source, Hint::Chosen))
}

/// The source of an attribute: what a vertex has by itself.
pub fn attribute_source(input: &Varying) -> (Source, Hint) {
    match input_source(input) {
        (Source::SeenPosition | Source::LightPosition, hint) => (Source::Position, hint),
        (Source::SeenNormal, hint) => (Source::Normal, hint),
        (Source::ToLight | Source::ToEye | Source::HalfWay | Source::Depth, _) => {
            (Source::Zero, Hint::Nothing)
        }
        found => found,
    }
}

#[cfg(test)]
pub mod tests {
    use super::{Hint, Source, attribute_source, input_source};
    use lamplight_bundle::Varying;

    /// An input or an attribute.
    pub fn input(name: &str, ty: &str, location: u32) -> Varying {
        Varying {
            name: Some(name.to_owned()),
            location: Some(location),
            builtin: None,
            ty: ty.to_owned(),
            shape: None,
            interpolation: None,
            sampling: None,
            blend_src: None,
        }
    }

    #[test]
    fn sources_of_names() {
        for (name, ty, location, expected) in [
            ("vNormal", "vec3<f32>", 3, (Source::Normal, Hint::Name)),
            ("n", "vec3<f32>", 0, (Source::Normal, Hint::Name)),
            ("FragPos", "vec3<f32>", 1, (Source::Position, Hint::Name)),
            ("v_world_position", "vec3<f32>", 1, (Source::Position, Hint::Name)),
            ("vUv", "vec2<f32>", 0, (Source::Uv, Hint::Name)),
            ("fragUV", "vec2<f32>", 0, (Source::Uv, Hint::Name)),
            ("TexCoords", "vec2<f32>", 0, (Source::Uv, Hint::Name)),
            ("to_lamp", "vec3<f32>", 0, (Source::ToLight, Hint::Name)),
            ("l", "vec3<f32>", 1, (Source::ToLight, Hint::Name)),
            ("v", "vec3<f32>", 2, (Source::ToEye, Hint::Name)),
            ("vViewPosition", "vec3<f32>", 2, (Source::SeenPosition, Hint::Name)),
            ("FragPosLightSpace", "vec4<f32>", 2, (Source::LightPosition, Hint::Name)),
            ("tangent", "vec4<f32>", 2, (Source::Tangent, Hint::Name)),
            ("ourColor", "vec3<f32>", 2, (Source::Color, Hint::Name)),
            ("a_b_c", "vec2<f32>", 1, (Source::Bitangent, Hint::Name)),
            ("what", "vec2<f32>", 1, (Source::Uv, Hint::Type)),
            ("what", "vec3<f32>", 0, (Source::Position, Hint::Type)),
            ("what", "vec3<f32>", 1, (Source::Zero, Hint::Nothing)),
            ("normal_index", "u32", 1, (Source::Zero, Hint::Nothing)),
        ] {
            assert_eq!(input_source(&input(name, ty, location)), expected, "{name}");
        }
        let light = input("light", "vec3<f32>", 1);
        assert_eq!(attribute_source(&light), (Source::Zero, Hint::Nothing));
        let seen = input("vertexPosition_modelspace", "vec3<f32>", 4);
        assert_eq!(attribute_source(&seen), (Source::Position, Hint::Name));
    }
}
