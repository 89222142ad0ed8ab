//! Types as GLSL has them.

use lamplight_diagnostic::Diagnostic;
use lamplight_diagnostic::source::Span;

use super::dialect::Dialect;
use crate::tree::{Scalar, Shape, Texture, TextureKind};
use crate::wesl::untranslated;

/// The name of an axis as a macro.
pub fn macro_name(axis: &str) -> String {
    axis.to_uppercase()
}

/// A scalar as GLSL names it.
pub fn scalar_name(scalar: Scalar, span: Span) -> Result<&'static str, Diagnostic> {
    match scalar {
        Scalar::Bool => Ok("bool"),
        Scalar::I32 => Ok("int"),
        Scalar::U32 => Ok("uint"),
        Scalar::F32 => Ok("float"),
        Scalar::AbstractInteger | Scalar::AbstractFloat => {
            Err(untranslated(span, "an abstract number"))
        }
    }
}

/// The beginning of the names of vectors of a scalar.
pub fn vector_prefix(scalar: Scalar, span: Span) -> Result<&'static str, Diagnostic> {
    Ok(match scalar_name(scalar, span)? {
        "bool" => "b",
        "int" => "i",
        "uint" => "u",
        _ => "",
    })
}

/// A vector: `vec3`, or `float3`.
pub fn vector_name(
    dialect: Dialect,
    size: u8,
    scalar: Scalar,
    span: Span,
) -> Result<String, Diagnostic> {
    match dialect {
        Dialect::Glsl => Ok(format!("{}vec{size}", vector_prefix(scalar, span)?)),
        Dialect::Hlsl | Dialect::Msl => Ok(format!("{}{size}", scalar_name(scalar, span)?)),
    }
}

/// `texture2D`, or another word in the place of `texture`.
pub fn texture_name(
    dialect: Dialect,
    texture: &Texture,
    word: &str,
    span: Span,
) -> Result<String, Diagnostic> {
    match dialect {
        Dialect::Glsl => {}
        Dialect::Hlsl => return super::hlsl::texture_name(texture, span),
        Dialect::Msl => return super::msl::texture_name(texture, span),
    }
    let shape = match texture.shape {
        Shape::D1 => "1D",
        Shape::D2 => "2D",
        Shape::D3 => "3D",
        Shape::Cube => "Cube",
    };
    let (letter, end) = match &texture.kind {
        TextureKind::Sampled(scalar) => (vector_prefix(*scalar, span)?, ""),
        TextureKind::Multisampled(scalar) => (vector_prefix(*scalar, span)?, "MS"),
        TextureKind::Depth => ("", ""),
        TextureKind::DepthMultisampled => ("", "MS"),
        TextureKind::Storage { .. } => return Err(untranslated(span, "a storage texture")),
    };
    let array = if texture.is_array { "Array" } else { "" };
    Ok(format!("{letter}{word}{shape}{end}{array}"))
}
