//! Textures in MSL: objects, whose methods take samplers.

use lamplight_diagnostic::Diagnostic;
use lamplight_diagnostic::source::Span;

use crate::tree::{Scalar, Shape, Texture, TextureKind};
use crate::wesl::untranslated;

/// `texture2d<float>`
pub fn texture_name(texture: &Texture, span: Span) -> Result<String, Diagnostic> {
    let shape = match texture.shape {
        Shape::D1 => "1d",
        Shape::D2 => "2d",
        Shape::D3 => "3d",
        Shape::Cube => "cube",
    };
    let (word, element) = match &texture.kind {
        TextureKind::Sampled(Scalar::F32) => ("texture", "float"),
        TextureKind::Sampled(Scalar::I32) => ("texture", "int"),
        TextureKind::Sampled(Scalar::U32) => ("texture", "uint"),
        TextureKind::Depth => ("depth", "float"),
        _ => return Err(untranslated(span, "this kind of texture")),
    };
    let array = if texture.is_array { "_array" } else { "" };
    Ok(format!("{word}{shape}{array}<{element}>"))
}

/// What follows the coordinates of a read, by its name in WGSL, from the arguments that WGSL has
/// there: the method, and the arguments.
pub fn argument_of(
    wgsl: &str,
    texture: &Texture,
    rest: &[String],
) -> Option<(&'static str, String)> {
    Some(match (wgsl, rest) {
        ("textureSample", []) => ("sample", String::new()),
        ("textureSampleBias", [bias]) => ("sample", format!(", bias({bias})")),
        ("textureSampleLevel", [level]) => ("sample", format!(", level({level})")),
        ("textureSampleGrad", [x, y]) => {
            let shape = match texture.shape {
                Shape::D1 => return None,
                Shape::D2 => "2d",
                Shape::D3 => "3d",
                Shape::Cube => "cube",
            };
            ("sample", format!(", gradient{shape}({x}, {y})"))
        }
        ("textureSampleCompare", [depth]) => ("sample_compare", format!(", {depth}")),
        ("textureSampleCompareLevel", [depth]) => {
            ("sample_compare", format!(", {depth}, level(0.0)"))
        }
        _ => return None,
    })
}
