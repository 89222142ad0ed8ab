//! Names and types as GLSL has them.

use lamplight_diagnostic::Diagnostic;
use lamplight_diagnostic::source::Span;

use crate::tree::{Count, ItemPath, Scalar, Shape, Texture, TextureKind, Type};
use crate::wesl::untranslated;

/// Words that GLSL or a version of it keeps for itself, and functions that the printer writes where
/// WGSL has another name.
const RESERVED: &[&str] = &[
    "active",
    "asm",
    "atan",
    "atomic_uint",
    "attribute",
    "barrier",
    "bitCount",
    "bitfieldExtract",
    "bitfieldInsert",
    "bitfieldReverse",
    "bool",
    "break",
    "buffer",
    "bvec2",
    "bvec3",
    "bvec4",
    "case",
    "cast",
    "centroid",
    "clamp",
    "class",
    "coherent",
    "common",
    "const",
    "continue",
    "dFdx",
    "dFdy",
    "default",
    "discard",
    "dmat2",
    "dmat3",
    "dmat4",
    "do",
    "double",
    "dvec2",
    "dvec3",
    "dvec4",
    "else",
    "enum",
    "equal",
    "extern",
    "external",
    "faceforward",
    "filter",
    "findLSB",
    "findMSB",
    "fixed",
    "flat",
    "float",
    "floatBitsToInt",
    "floatBitsToUint",
    "for",
    "fvec2",
    "fvec3",
    "fvec4",
    "goto",
    "greaterThan",
    "greaterThanEqual",
    "half",
    "highp",
    "hvec2",
    "hvec3",
    "hvec4",
    "if",
    "iimage2D",
    "image2D",
    "imageLoad",
    "imageSize",
    "imageStore",
    "in",
    "inline",
    "inout",
    "input",
    "int",
    "intBitsToFloat",
    "interface",
    "invariant",
    "inverse",
    "inversesqrt",
    "isinf",
    "isnan",
    "isampler2D",
    "isampler3D",
    "isamplerCube",
    "itexture2D",
    "ivec2",
    "ivec3",
    "ivec4",
    "layout",
    "lessThan",
    "lessThanEqual",
    "long",
    "lowp",
    "main",
    "mat2",
    "mat2x2",
    "mat2x3",
    "mat2x4",
    "mat3",
    "mat3x2",
    "mat3x3",
    "mat3x4",
    "mat4",
    "mat4x2",
    "mat4x3",
    "mat4x4",
    "matrixCompMult",
    "max",
    "mediump",
    "min",
    "mix",
    "mod",
    "namespace",
    "noinline",
    "noise1",
    "noise2",
    "noise3",
    "noise4",
    "noperspective",
    "not",
    "notEqual",
    "out",
    "outerProduct",
    "output",
    "partition",
    "patch",
    "precise",
    "precision",
    "public",
    "readonly",
    "resource",
    "restrict",
    "return",
    "roundEven",
    "sample",
    "sampler",
    "sampler1D",
    "sampler2D",
    "sampler2DArray",
    "sampler2DRect",
    "sampler2DShadow",
    "sampler3D",
    "samplerCube",
    "samplerCubeShadow",
    "samplerShadow",
    "shared",
    "short",
    "sizeof",
    "smooth",
    "static",
    "struct",
    "subroutine",
    "superp",
    "switch",
    "template",
    "texelFetch",
    "texture",
    "texture1D",
    "texture2D",
    "texture3D",
    "textureCube",
    "textureGrad",
    "textureLod",
    "textureSize",
    "this",
    "true",
    "trunc",
    "false",
    "typedef",
    "uimage2D",
    "uint",
    "uintBitsToFloat",
    "uniform",
    "union",
    "unsigned",
    "usampler2D",
    "using",
    "utexture2D",
    "uvec2",
    "uvec3",
    "uvec4",
    "varying",
    "vec2",
    "vec3",
    "vec4",
    "void",
    "volatile",
    "while",
    "writeonly",
];

/// A name that GLSL accepts.
pub fn glsl_name(name: &str) -> String {
    let is_reserved = RESERVED.contains(&name) || name.starts_with("gl_") || name.contains("__");
    match is_reserved {
        true => format!("{}_", name.replace("__", "_").trim_start_matches("gl_")),
        false => name.to_owned(),
    }
}

/// The name of a declared item.
pub fn item_name(path: &ItemPath) -> String {
    glsl_name(&path.name)
}

/// The name of an axis as a macro.
pub fn macro_name(axis: &str) -> String {
    axis.to_uppercase()
}

/// A type and the lengths that stand behind the declared name, such as `vec3` and `[9]`.
pub fn declared_type(ty: &Type, span: Span) -> Result<(String, String), Diagnostic> {
    match ty {
        Type::Array(element, count) => {
            let (name, inner) = declared_type(element, span)?;
            Ok((name, format!("[{}]{inner}", count_text(count))))
        }
        other => Ok((type_name(other, span)?, String::new())),
    }
}

/// A type as one word, such as `vec3[9]`.
pub fn type_name(ty: &Type, span: Span) -> Result<String, Diagnostic> {
    Ok(match ty {
        Type::Nothing => "void".to_owned(),
        Type::Scalar(scalar) => scalar_name(*scalar, span)?.to_owned(),
        Type::Vector(size, scalar) => format!("{}vec{size}", prefix(*scalar, span)?),
        Type::Matrix { columns, rows, scalar: _ } if columns == rows => format!("mat{columns}"),
        Type::Matrix { columns, rows, scalar: _ } => format!("mat{columns}x{rows}"),
        Type::Array(..) => {
            let (name, lengths) = declared_type(ty, span)?;
            format!("{name}{lengths}")
        }
        Type::Structure(path) => item_name(path),
        Type::Pointer(_, target) => type_name(target, span)?,
        Type::Texture(texture) => texture_name(texture, "texture", span)?,
        Type::Sampler { compares: false } => "sampler".to_owned(),
        Type::Sampler { compares: true } => "samplerShadow".to_owned(),
        Type::Atomic(_) => return Err(untranslated(span, "an atomic type")),
        other => return Err(untranslated(span, format!("the type {other}"))),
    })
}

pub fn count_text(count: &Count) -> String {
    match count {
        Count::Fixed(count) => count.to_string(),
        Count::Axis(name) => macro_name(name),
        Count::Constant(name) => glsl_name(name),
        Count::Runtime => String::new(),
    }
}

fn scalar_name(scalar: Scalar, span: Span) -> Result<&'static str, Diagnostic> {
    match scalar {
        Scalar::Bool => Ok("bool"),
        Scalar::I32 => Ok("int"),
        Scalar::U32 => Ok("uint"),
        Scalar::F32 => Ok("float"),
        Scalar::AbstractInteger | Scalar::AbstractFloat => {
            Err(untranslated(span, "a number without a size"))
        }
    }
}

fn prefix(scalar: Scalar, span: Span) -> Result<&'static str, Diagnostic> {
    Ok(match scalar_name(scalar, span)? {
        "bool" => "b",
        "int" => "i",
        "uint" => "u",
        _ => "",
    })
}

/// `texture2D`, or another word in the place of `texture`.
pub fn texture_name(texture: &Texture, word: &str, span: Span) -> Result<String, Diagnostic> {
    let shape = match texture.shape {
        Shape::D1 => "1D",
        Shape::D2 => "2D",
        Shape::D3 => "3D",
        Shape::Cube => "Cube",
    };
    let (letter, end) = match &texture.kind {
        TextureKind::Sampled(scalar) => (prefix(*scalar, span)?, ""),
        TextureKind::Multisampled(scalar) => (prefix(*scalar, span)?, "MS"),
        TextureKind::Depth => ("", ""),
        TextureKind::DepthMultisampled => ("", "MS"),
        TextureKind::Storage { .. } => return Err(untranslated(span, "a storage texture")),
    };
    let array = if texture.is_array { "Array" } else { "" };
    Ok(format!("{letter}{word}{shape}{end}{array}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reserved_words_are_renamed() {
        assert_eq!(glsl_name("sample"), "sample_");
        assert_eq!(glsl_name("gl_Position"), "Position_");
        assert_eq!(glsl_name("a__b"), "a_b_");
        assert_eq!(glsl_name("roughness"), "roughness");
    }
}
