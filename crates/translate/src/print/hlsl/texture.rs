//! Textures in HLSL: objects, whose methods take samplers.

use lamplight_diagnostic::Diagnostic;
use lamplight_diagnostic::source::Span;

use crate::tree::{Scalar, Shape, Texture, TextureKind};
use crate::wesl::untranslated;

/// `Texture2D<float4>`
pub fn texture_name(texture: &Texture, span: Span) -> Result<String, Diagnostic> {
    let shape = match texture.shape {
        Shape::D1 => "1D",
        Shape::D2 => "2D",
        Shape::D3 => "3D",
        Shape::Cube => "Cube",
    };
    let element = match &texture.kind {
        TextureKind::Sampled(Scalar::F32) => "float4",
        TextureKind::Sampled(Scalar::I32) => "int4",
        TextureKind::Sampled(Scalar::U32) => "uint4",
        TextureKind::Depth => "float",
        _ => return Err(untranslated(span, "this kind of texture")),
    };
    let array = if texture.is_array { "Array" } else { "" };
    Ok(format!("Texture{shape}{array}<{element}>"))
}

/// A read by its name in WGSL: the method, and how many arguments are behind the coordinates.
pub fn method_name(wgsl: &str) -> Option<(&'static str, usize)> {
    Some(match wgsl {
        "textureSample" => ("Sample", 0),
        "textureSampleBias" => ("SampleBias", 1),
        "textureSampleLevel" => ("SampleLevel", 1),
        "textureSampleGrad" => ("SampleGrad", 2),
        "textureSampleCompare" => ("SampleCmp", 1),
        "textureSampleCompareLevel" => ("SampleCmpLevelZero", 1),
        _ => return None,
    })
}

/// A function that gives the size of a texture as WGSL does.
pub fn size_function(texture: &Texture, span: Span) -> Result<(String, String), Diagnostic> {
    if texture.is_array || !matches!(texture.shape, Shape::D2 | Shape::Cube) {
        return Err(untranslated(span, "the size of this kind of texture"));
    }
    let ty = texture_name(texture, span)?;
    let mark: String =
        ty.to_uppercase().chars().filter(|letter| letter.is_ascii_alphanumeric()).collect();
    let text = format!(
        "uint2 texture_size({ty} map, uint level) {{\n    uint2 size;\n    uint levels;\n    \
         map.GetDimensions(level, size.x, size.y, levels);\n    return size;\n}}\n"
    );
    Ok((format!("TEXTURE_SIZE_{mark}"), text))
}
