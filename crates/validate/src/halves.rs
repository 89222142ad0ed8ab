//! Refuses `frexp` of `f16`. naga gives its exponent the type `i16`, which WGSL does not have: it is
//! an `i32` there.

use naga::{Expression, MathFunction, Module, PredeclaredType, Scalar};

use super::uses::functions;
use lamplight_compose::Composed;
use lamplight_diagnostic::{Diagnostic, codes};

/// The type that naga names in messages about the exponent.
const WRONG: &str = "`i16`";

/// What to write instead.
pub const ADVICE: &str = "help: take `frexp(f32(x))`, whose exponent is the same";

/// Whether a message of naga is about such an exponent.
pub fn is_about_exponent(message: &str) -> bool {
    message.contains(WRONG)
}

/// Refuses the first call in a module.
pub fn refuse_exponents(composed: &Composed, module: &Module) -> Result<(), Diagnostic> {
    let is_half = |result: &PredeclaredType| match result {
        PredeclaredType::FrexpResult { size: _, scalar } => *scalar == Scalar::F16,
        _ => false,
    };
    if !module.special_types.predeclared_types.keys().any(is_half) {
        return Ok(());
    }
    let is_call = |expression: &Expression| {
        matches!(expression, Expression::Math { fun: MathFunction::Frexp, .. })
    };
    let place = functions(module).find_map(|function| {
        let mut all = function.expressions.iter();
        all.find(|(_, one)| is_call(one)).map(|(at, _)| function.expressions.get_span(at))
    });
    let error =
        Diagnostic::error(codes::NOT_PORTABLE, "no target has `frexp` of `f16`").note(ADVICE);
    let place = place.as_ref().and_then(|span| span.to_range());
    Err(match place.and_then(|range| composed.map.lookup(range)) {
        Some(span) => error.at(span, "this call"),
        None => error,
    })
}
