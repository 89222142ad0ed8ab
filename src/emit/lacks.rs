//! What naga writes in GLSL although the language does not have it, or means something else by it.
//!
//! GLSL 3.30 and GLSL ES 3.00 are older than some functions, whose names naga writes all the same;
//! for `frexp` it writes one of its own, by `log2`, which is wrong for negative numbers and small
//! ones. In std140 a column of a matrix of two rows takes 16 bytes, in WGSL and in a reflection 8.

use naga::back::glsl::Version;
use naga::{
    AddressSpace, Expression, Handle, MathFunction, Module, Span, Type, TypeInner, VectorSize,
};

use crate::bundle::Target;
use crate::compose::Composed;
use crate::diagnostic::{Diagnostic, Diagnostics, codes};

/// Functions of WGSL, as GLSL calls what naga writes for them.
const LATER: &[(MathFunction, &str)] = &[
    (MathFunction::CountOneBits, "bitCount"),
    (MathFunction::CountTrailingZeros, "findLSB"),
    (MathFunction::Dot4I8Packed, "bitfieldExtract"),
    (MathFunction::Dot4U8Packed, "bitfieldExtract"),
    (MathFunction::ExtractBits, "bitfieldExtract"),
    (MathFunction::FirstLeadingBit, "findMSB"),
    (MathFunction::FirstTrailingBit, "findLSB"),
    (MathFunction::Frexp, "frexp"),
    (MathFunction::InsertBits, "bitfieldInsert"),
    (MathFunction::Ldexp, "ldexp"),
    (MathFunction::Pack4xI8, "bitfieldInsert"),
    (MathFunction::Pack4xI8Clamp, "bitfieldInsert"),
    (MathFunction::Pack4xU8, "bitfieldInsert"),
    (MathFunction::Pack4xU8Clamp, "bitfieldInsert"),
    (MathFunction::ReverseBits, "bitfieldReverse"),
    (MathFunction::Unpack4xI8, "bitfieldExtract"),
    (MathFunction::Unpack4xU8, "bitfieldExtract"),
];

const TWO_ROWS: &str =
    "a matrix of two rows in a uniform block is laid out otherwise in GLSL: use vectors";

/// Refuses what targets do not have, in the author's places where `composed` knows them.
///
/// # Errors
/// `emit-failed` for each.
pub fn check(composed: &Composed, module: &Module, targets: &[Target]) -> Result<(), Diagnostics> {
    let mut found = Diagnostics::new();
    for (target, version) in VERSIONS {
        if !targets.contains(target) {
            continue;
        }
        let functions = lacking(module, *version)
            .map(|(name, span)| (told(*target, name), span, "it is written so"));
        let blocks = two_rows(module)
            .map(|span| (format!("target `{target}`: {TWO_ROWS}"), span, "it is in here"));
        for (message, span, label) in functions.chain(blocks) {
            let place = span.to_range().and_then(|range| composed.map.lookup(range));
            let error = Diagnostic::error(codes::EMIT_FAILED, message);
            found.push(place.into_iter().fold(error, |error, span| error.at(span, label)));
        }
    }
    if found.is_empty() { Ok(()) } else { Err(found) }
}

const VERSIONS: &[(Target, Version)] = &[
    (Target::GLSL450, Version::Desktop(450)),
    (Target::GLSL330, Version::Desktop(330)),
    (Target::ESSL300, Version::new_gles(300)),
];

fn told(target: Target, name: &str) -> String {
    format!("target `{target}`: the language has no `{name}`, which is needed here")
}

/// The first thing that a version does not have.
pub fn first(module: &Module, version: Version) -> Option<String> {
    if two_rows(module).next().is_some() {
        return Some(TWO_ROWS.to_owned());
    }
    let (name, _) = lacking(module, version).next()?;
    Some(format!("the language has no `{name}`, which is needed"))
}

/// Uniform blocks with matrices of two rows.
fn two_rows(module: &Module) -> impl Iterator<Item = Span> {
    let blocks = module.global_variables.iter();
    let blocks = blocks.filter(|(_, one)| one.space == AddressSpace::Uniform);
    blocks
        .filter(|(_, one)| has_two_rows(module, one.ty))
        .map(|(handle, _)| module.global_variables.get_span(handle))
}

fn has_two_rows(module: &Module, ty: Handle<Type>) -> bool {
    match &module.types[ty].inner {
        TypeInner::Matrix { rows, .. } => *rows == VectorSize::Bi,
        TypeInner::Array { base, .. } => has_two_rows(module, *base),
        TypeInner::Struct { members, .. } => {
            members.iter().any(|member| has_two_rows(module, member.ty))
        }
        _ => false,
    }
}

fn lacking(module: &Module, version: Version) -> impl Iterator<Item = (&'static str, Span)> {
    let is_old = version != Version::Desktop(450);
    let points = module.entry_points.iter().map(|point| &point.function);
    let all = module.functions.iter().map(|(_, function)| function).chain(points);
    let all = all.filter(move |_| is_old);
    all.flat_map(move |function| {
        let expressions = function.expressions.iter();
        expressions.filter_map(move |(handle, expression)| {
            Some((later(version, expression)?, function.expressions.get_span(handle)))
        })
    })
}

/// What GLSL calls a function that a version does not have.
fn later(version: Version, expression: &Expression) -> Option<&'static str> {
    match expression {
        Expression::Math { fun: MathFunction::QuantizeToF16, .. } => {
            (version == Version::Desktop(330)).then_some("unpackHalf2x16")
        }
        Expression::Math { fun, .. } => {
            LATER.iter().find(|(known, _)| known == fun).map(|(_, name)| *name)
        }
        Expression::ImageSample { gather: Some(_), .. } => Some("textureGather"),
        _ => None,
    }
}
