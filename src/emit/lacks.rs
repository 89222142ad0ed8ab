//! Functions that GLSL 3.30 and GLSL ES 3.00 do not have: both are older than these, and naga
//! writes their names all the same.

use naga::back::glsl::Version;
use naga::{Expression, MathFunction, Module, Span};

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

/// Refuses functions that targets do not have, in the author's places where `composed` knows them.
///
/// # Errors
/// `emit-failed` for each.
pub fn check(composed: &Composed, module: &Module, targets: &[Target]) -> Result<(), Diagnostics> {
    let mut found = Diagnostics::new();
    for (target, version) in VERSIONS {
        if !targets.contains(target) {
            continue;
        }
        for (name, span) in lacking(module, *version) {
            let place = span.to_range().and_then(|range| composed.map.lookup(range));
            let error = Diagnostic::error(codes::EMIT_FAILED, told(*target, name));
            found.push(
                place.into_iter().fold(error, |error, span| error.at(span, "it is written so")),
            );
        }
    }
    if found.is_empty() { Ok(()) } else { Err(found) }
}

const VERSIONS: &[(Target, Version)] =
    &[(Target::GLSL330, Version::Desktop(330)), (Target::ESSL300, Version::new_gles(300))];

fn told(target: Target, name: &str) -> String {
    format!("target `{target}`: the language has no `{name}`, which is needed here")
}

/// The first function that a version does not have.
pub fn first(module: &Module, version: Version) -> Option<String> {
    let (name, _) = lacking(module, version).next()?;
    Some(format!("the language has no `{name}`, which is needed"))
}

fn lacking(module: &Module, version: Version) -> impl Iterator<Item = (&'static str, Span)> {
    let is_old = VERSIONS.iter().any(|(_, known)| *known == version);
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
