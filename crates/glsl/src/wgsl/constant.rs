//! Numbers as WGSL writes them.

use super::Writer;
use super::value::{Strength, Value};
use crate::tree::{Expr, ExprKind, Number, Op};
use crate::types::{Scalar, Type};

impl Writer<'_> {
    /// A number.
    pub(super) fn number(&mut self, number: Number) -> Value {
        let text = match number {
            Number::Bool(value) => value.to_string(),
            Number::Int(value) if self.suffixed && value >= 0 => format!("{value}i"),
            Number::Int(value) => value.to_string(),
            Number::Uint(value) => format!("{value}u"),
            Number::Float(value) => return self.float(value),
        };
        let strength = if text.starts_with('-') { Strength::Unary } else { Strength::Primary };
        Value { text, strength, stable: true }
    }

    /// A number that is not finite has no literal: its bits go through a function, which is not a
    /// constant expression.
    fn float(&mut self, value: f32) -> Value {
        if !value.is_finite() {
            let helper = self.helper("float_of_bits", super::helpers::FLOAT_OF_BITS);
            return Value::primary(format!("{helper}({:#010x}u)", value.to_bits()), true);
        }
        let mut text = format!("{value:?}");
        if self.suffixed {
            text.push('f');
        }
        let strength = if text.starts_with('-') { Strength::Unary } else { Strength::Primary };
        Value { text, strength, stable: true }
    }

    /// A literal as it was written, if WGSL reads it so.
    pub(super) fn literal(&mut self, number: Number, text: Option<&str>) -> Value {
        let plain = |text: &&str| text.len() < 30;
        match (number, text.filter(plain)) {
            (Number::Float(value), Some(text)) if value.is_finite() => {
                let is_bare = !text.contains(['.', 'e', 'E']);
                let point = if is_bare { ".0" } else { "" };
                let suffix = if self.suffixed { "f" } else { "" };
                // A literal too small for `f32` is no constant of WGSL's either.
                let lost = value == 0.0 && text.contains(|digit| matches!(digit, '1'..='9'));
                if lost {
                    return self.float(value);
                }
                Value::primary(format!("{text}{point}{suffix}"), true)
            }
            _ => self.number(number),
        }
    }

    /// A constant of numbers.
    pub(super) fn known_text(&mut self, ty: &Type, known: &[Number]) -> Option<Value> {
        match ty {
            Type::Scalar(_) => known.first().map(|number| self.number(*number)),
            Type::Vector(..) | Type::Matrix(..) => {
                let texts: Vec<String> =
                    known.iter().map(|number| self.number(*number).text).collect();
                let name = self.type_text(ty);
                Some(Value::primary(format!("{name}({})", texts.join(", ")), true))
            }
            _ => None,
        }
    }
}

/// Whether a front end of WGSL would refuse to evaluate a constant expression as it is written:
/// integers that wrap, shifts that lose bits, results that are not finite.
pub(super) fn is_risky(expr: &Expr) -> bool {
    let Some(known) = &expr.known else { return false };
    let infinite = |number: &Number| matches!(number, Number::Float(value) if !value.is_finite());
    if known.iter().any(infinite) {
        return true;
    }
    match &expr.kind {
        ExprKind::Binary(op, left, right) => {
            is_risky(left) || is_risky(right) || overflows(*op, left, right)
        }
        ExprKind::Unary(op, operand) => {
            let least = |number: &Number| *number == Number::Int(i32::MIN);
            let negated = *op == Op::Negate
                && (operand.known.iter().any(|known| known.iter().any(least))
                    || operand.ty.scalar() == Some(Scalar::Uint));
            is_risky(operand) || negated
        }
        ExprKind::Construct(parts) | ExprKind::Builtin(_, parts) => parts.iter().any(is_risky),
        ExprKind::Convert(inner) => is_risky(inner) || is_lossy(inner, &expr.ty),
        ExprKind::Swizzle(base, _) | ExprKind::Member(base, _) => is_risky(base),
        ExprKind::Index(base, index) => is_risky(base) || is_risky(index),
        ExprKind::Ternary(condition, yes, no) => {
            is_risky(condition) || is_risky(yes) || is_risky(no)
        }
        _ => false,
    }
}

/// Conversions whose value WGSL leaves open or clamps otherwise.
fn is_lossy(inner: &Expr, to: &Type) -> bool {
    let integer = matches!(to.scalar(), Some(Scalar::Int | Scalar::Uint));
    integer
        && inner.known.iter().any(|known| {
            known.iter().any(|number| match number {
                Number::Float(value) => *value < 0.0 || *value >= 2_147_483_647.0,
                Number::Int(value) => *value < 0,
                Number::Uint(value) => *value > i32::MAX as u32,
                Number::Bool(_) => false,
            })
        })
}

fn overflows(op: Op, left: &Expr, right: &Expr) -> bool {
    let (Some(a), Some(b)) = (&left.known, &right.known) else { return false };
    let count = a.len().max(b.len());
    let at = |known: &[Number], index: usize| {
        if known.len() == 1 { known[0] } else { known.get(index).copied().unwrap_or(known[0]) }
    };
    (0..count).any(|index| overflows_number(op, at(a, index), at(b, index)))
}

fn overflows_number(op: Op, a: Number, b: Number) -> bool {
    let wide = |number: Number| match number {
        Number::Int(value) => Some(i64::from(value)),
        Number::Uint(value) => Some(i64::from(value)),
        _ => None,
    };
    let (Some(x), Some(y)) = (wide(a), wide(b)) else { return false };
    let range = match a {
        Number::Uint(_) => 0..=i64::from(u32::MAX),
        _ => i64::from(i32::MIN)..=i64::from(i32::MAX),
    };
    let exact = match op {
        Op::Add => x.checked_add(y),
        Op::Sub => x.checked_sub(y),
        Op::Mul => x.checked_mul(y),
        Op::Div => x.checked_div(y),
        Op::Mod => x.checked_rem(y),
        Op::ShiftLeft => return true,
        Op::ShiftRight => return !(0..32).contains(&y),
        _ => return false,
    };
    exact.is_none_or(|value| !range.contains(&value))
}
