//! The order in which effects happen. WGSL computes operands from left to right; GLSL leaves the
//! order open but for `&&`, `||`, `?:` and the arguments of calls.

use lamplight_diagnostic::Diagnostic;

use super::expression::Writer;
use crate::tree::{Binary, Callee, Expression, ExpressionKind};
use crate::wesl::untranslated;

/// An error if GLSL may compute an expression in an order that WGSL does not.
pub fn check_order(writer: &Writer<'_>, value: &Expression) -> Result<(), Diagnostic> {
    if !writer.facts.has_effects(value) {
        return Ok(());
    }
    match &value.kind {
        ExpressionKind::Parenthesised(inner)
        | ExpressionKind::Unary(_, inner)
        | ExpressionKind::Member(inner, _)
        | ExpressionKind::Convert(inner) => check_order(writer, inner),
        ExpressionKind::Binary { operator: Binary::And | Binary::Or, left, right, .. } => {
            check_order(writer, left)?;
            check_order(writer, right)
        }
        ExpressionKind::Binary { left, right, .. } | ExpressionKind::Index(left, right) => {
            match (is_fixed(left), is_fixed(right)) {
                (true, _) => check_order(writer, right),
                (_, true) => check_order(writer, left),
                _ => Err(refused(value)),
            }
        }
        ExpressionKind::Call { callee, arguments, .. } => {
            let mut acting =
                arguments.iter().filter(|argument| writer.facts.has_effects(&argument.value));
            match (acting.next(), acting.next(), callee) {
                (None, ..) => Ok(()),
                (Some(argument), None, Callee::Construct(_) | Callee::Builtin(_))
                    if arguments
                        .iter()
                        .all(|other| std::ptr::eq(other, argument) || is_fixed(&other.value)) =>
                {
                    check_order(writer, &argument.value)
                }
                _ => Err(refused(value)),
            }
        }
        ExpressionKind::Number(_)
        | ExpressionKind::Bool(_)
        | ExpressionKind::Name(..)
        | ExpressionKind::Axis(_) => Ok(()),
    }
}

/// Whether nothing can change a value.
fn is_fixed(value: &Expression) -> bool {
    let mut fixed = true;
    value.walk(&mut |part| {
        fixed &= !matches!(part.kind, ExpressionKind::Name(..) | ExpressionKind::Call { .. });
    });
    fixed
}

fn refused(value: &Expression) -> Diagnostic {
    untranslated(value.span, "operands of which one has effects")
        .note("help: give the operands names first, in the order in which they are computed")
}
