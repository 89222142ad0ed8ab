//! Types of the functions of WGSL.

use lamplight_diagnostic::Diagnostic;
use lamplight_diagnostic::source::Span;

use super::constant::{convert, default_type};
use super::expression::mismatch;
use super::scope::Scope;
use crate::tree::{Argument, Scalar, Shape, Texture, TextureKind, Type};
use crate::wesl::untranslated;

/// How the type of a result follows from those of the arguments.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Rule {
    /// That of the first argument; all are of one scalar.
    Same,
    /// The same, of numbers that have a size.
    SameSized,
    /// The scalar of the first argument.
    Part,
    /// A boolean.
    Truth,
    /// A fixed type.
    Is(Type32),
    Transposed,
    Select,
    Texture,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Type32 {
    Nothing,
    U32,
    Vec2F,
    Vec4F,
}

/// Functions by the rule of their results.
const RULES: &[(Rule, &[&str])] = &[
    (
        Rule::Same,
        &[
            "abs",
            "acos",
            "acosh",
            "asin",
            "asinh",
            "atan",
            "atanh",
            "atan2",
            "ceil",
            "clamp",
            "cos",
            "cosh",
            "cross",
            "degrees",
            "exp",
            "exp2",
            "faceForward",
            "floor",
            "fma",
            "fract",
            "inverseSqrt",
            "log",
            "log2",
            "max",
            "min",
            "mix",
            "normalize",
            "pow",
            "radians",
            "reflect",
            "refract",
            "round",
            "saturate",
            "sign",
            "sin",
            "sinh",
            "smoothstep",
            "sqrt",
            "step",
            "tan",
            "tanh",
            "trunc",
        ],
    ),
    (
        Rule::SameSized,
        &[
            "countLeadingZeros",
            "countOneBits",
            "countTrailingZeros",
            "dpdx",
            "dpdxCoarse",
            "dpdxFine",
            "dpdy",
            "dpdyCoarse",
            "dpdyFine",
            "firstLeadingBit",
            "firstTrailingBit",
            "fwidth",
            "fwidthCoarse",
            "fwidthFine",
            "reverseBits",
            "ldexp",
            "extractBits",
            "insertBits",
            "quantizeToF16",
        ],
    ),
    (Rule::Part, &["determinant", "distance", "dot", "length"]),
    (Rule::Truth, &["all", "any"]),
    (Rule::Transposed, &["transpose"]),
    (Rule::Select, &["select"]),
    (Rule::Is(Type32::U32), &["pack2x16float", "pack2x16snorm", "pack2x16unorm"]),
    (Rule::Is(Type32::U32), &["pack4x8snorm", "pack4x8unorm", "arrayLength"]),
    (Rule::Is(Type32::Vec2F), &["unpack2x16float", "unpack2x16snorm", "unpack2x16unorm"]),
    (Rule::Is(Type32::Vec4F), &["unpack4x8snorm", "unpack4x8unorm"]),
    (Rule::Is(Type32::Nothing), &["workgroupBarrier", "storageBarrier", "textureStore"]),
    (
        Rule::Texture,
        &[
            "textureDimensions",
            "textureGather",
            "textureGatherCompare",
            "textureLoad",
            "textureNumLayers",
            "textureNumLevels",
            "textureNumSamples",
            "textureSample",
            "textureSampleBaseClampToEdge",
            "textureSampleBias",
            "textureSampleCompare",
            "textureSampleCompareLevel",
            "textureSampleGrad",
            "textureSampleLevel",
        ],
    ),
];

/// The functions that compute with the values of neighbouring fragments.
pub const DERIVATIVES: [&str; 12] = [
    "dpdx",
    "dpdxCoarse",
    "dpdxFine",
    "dpdy",
    "dpdyCoarse",
    "dpdyFine",
    "fwidth",
    "fwidthCoarse",
    "fwidthFine",
    "textureSample",
    "textureSampleBias",
    "textureSampleCompare",
];

/// Whether the language has a function of the name.
pub fn is_builtin(name: &str) -> bool {
    RULES.iter().any(|(_, names)| names.contains(&name))
}

impl Scope<'_> {
    /// The type of a call of a function of the language.
    pub fn builtin(
        &mut self,
        name: &str,
        arguments: &mut [Argument],
        span: Span,
    ) -> Result<Type, Diagnostic> {
        let Some((rule, _)) = RULES.iter().find(|(_, names)| names.contains(&name)) else {
            return Err(untranslated(span, format!("the function `{name}`")));
        };
        let first = |arguments: &[Argument]| {
            let first = arguments.first().map(|argument| argument.value.ty.clone());
            first.ok_or_else(|| mismatch(span, format!("`{name}` without arguments")))
        };
        match rule {
            Rule::Same | Rule::Part => drop(self.unify_arguments(arguments)?),
            Rule::SameSized | Rule::Transposed | Rule::Truth | Rule::Is(_) => {
                self.same_sized(arguments)?;
            }
            Rule::Select => return self.select(arguments, span),
            Rule::Texture => return self.texture(name, arguments, span),
        }
        let first_type = match rule {
            Rule::Is(_) => Type::Nothing,
            _ => first(arguments)?,
        };
        Ok(match rule {
            Rule::Part => match (first_type.scalar(), name) {
                (Some(Scalar::AbstractInteger), "length" | "distance") => {
                    return Err(mismatch(span, "a length of integers".to_owned()));
                }
                (Some(scalar), _) => Type::Scalar(scalar),
                (None, _) => return Err(mismatch(span, format!("`{name}` of {first_type}"))),
            },
            Rule::Truth => Type::BOOL,
            Rule::Is(ty) => fixed(*ty),
            Rule::Transposed => match first_type {
                Type::Matrix { columns, rows, scalar } => {
                    Type::Matrix { columns: rows, rows: columns, scalar }
                }
                other => return Err(mismatch(span, format!("`{name}` of {other}"))),
            },
            _ => float_result(name, first_type),
        })
    }

    fn same_sized(&self, arguments: &mut [Argument]) -> Result<(), Diagnostic> {
        for argument in arguments {
            let ty = default_type(&argument.value.ty);
            convert(&mut argument.value, &ty, self.globals)?;
        }
        Ok(())
    }

    /// `select(reject, accept, condition)`.
    fn select(&mut self, arguments: &mut [Argument], span: Span) -> Result<Type, Diagnostic> {
        let [reject, accept, condition] = arguments else {
            return Err(mismatch(span, "`select` takes three arguments".to_owned()));
        };
        self.unify(&mut [&mut reject.value, &mut accept.value])?;
        let is_condition = condition.value.ty.scalar() == Some(Scalar::Bool);
        match reject.value.ty == accept.value.ty && is_condition {
            true => Ok(reject.value.ty.clone()),
            false => Err(mismatch(span, "`select` takes two alike and a condition".to_owned())),
        }
    }

    fn texture(
        &mut self,
        name: &str,
        arguments: &mut [Argument],
        span: Span,
    ) -> Result<Type, Diagnostic> {
        let gathers = name == "textureGather" && !has_texture(arguments.first());
        let Some(Type::Texture(texture)) =
            arguments.get(usize::from(gathers)).map(|argument| argument.value.ty.clone())
        else {
            return Err(mismatch(span, format!("`{name}` without a texture")));
        };
        let counts = name == "textureLoad";
        for (index, argument) in arguments.iter_mut().enumerate() {
            // Coordinates are floats, and so are levels, but for those of loads.
            let target = match argument.value.ty.scalar() {
                Some(Scalar::AbstractInteger) if !counts && index > 1 && !texture.is_array => {
                    argument.value.ty.with_scalar(Scalar::F32)
                }
                _ => default_type(&argument.value.ty),
            };
            convert(&mut argument.value, &target, self.globals)?;
        }
        Ok(texture_result(name, &texture))
    }
}

fn has_texture(argument: Option<&Argument>) -> bool {
    argument.is_some_and(|argument| matches!(argument.value.ty, Type::Texture(_)))
}

fn texture_result(name: &str, texture: &Texture) -> Type {
    let texel = |scalar: Scalar| Type::Vector(4, scalar);
    match name {
        "textureDimensions" => match texture.shape {
            Shape::D1 => Type::U32,
            Shape::D2 | Shape::Cube => Type::Vector(2, Scalar::U32),
            Shape::D3 => Type::Vector(3, Scalar::U32),
        },
        "textureNumLayers" | "textureNumLevels" | "textureNumSamples" => Type::U32,
        "textureGather" | "textureGatherCompare" => match texture.kind {
            TextureKind::Sampled(scalar) => texel(scalar),
            _ => texel(Scalar::F32),
        },
        "textureSampleCompare" | "textureSampleCompareLevel" => Type::F32,
        _ => match &texture.kind {
            TextureKind::Sampled(scalar) | TextureKind::Multisampled(scalar) => texel(*scalar),
            TextureKind::Depth | TextureKind::DepthMultisampled => Type::F32,
            TextureKind::Storage { format, .. } => texel(match format.as_str() {
                name if name.ends_with("uint") => Scalar::U32,
                name if name.ends_with("sint") => Scalar::I32,
                _ => Scalar::F32,
            }),
        },
    }
}

fn fixed(ty: Type32) -> Type {
    match ty {
        Type32::Nothing => Type::Nothing,
        Type32::U32 => Type::U32,
        Type32::Vec2F => Type::Vector(2, Scalar::F32),
        Type32::Vec4F => Type::Vector(4, Scalar::F32),
    }
}

/// Functions of floats make abstract floats of abstract integers.
fn float_result(name: &str, first: Type) -> Type {
    let keeps = matches!(name, "abs" | "clamp" | "max" | "min" | "sign");
    match first.scalar() {
        Some(Scalar::AbstractInteger) if !keeps => first.with_scalar(Scalar::AbstractFloat),
        _ => first,
    }
}
