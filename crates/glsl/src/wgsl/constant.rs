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

/// Whether a constant expression is written as its value: where WGSL would refuse it, and where front
/// ends of WGSL differ.
pub(super) fn is_risky(expr: &Expr) -> bool {
    is_some_part(expr, &|part| match &part.kind {
        ExprKind::Binary(Op::ShiftLeft, left, right) => {
            left.known.is_some() && right.known.is_some()
        }
        ExprKind::Convert(inner) => is_lossy(inner, &part.ty),
        _ => is_refused(part),
    })
}

/// Whether something holds for a constant expression or for one that it is computed from.
fn is_some_part(expr: &Expr, holds: &dyn Fn(&Expr) -> bool) -> bool {
    let parts = |list: &[Expr]| list.iter().any(|part| is_some_part(part, holds));
    let either = |one: &Expr, other: &Expr| is_some_part(one, holds) || is_some_part(other, holds);
    if expr.known.is_none() {
        return false;
    }
    holds(expr)
        || match &expr.kind {
            ExprKind::Binary(_, left, right) => either(left, right),
            ExprKind::Unary(_, operand) => is_some_part(operand, holds),
            ExprKind::Construct(list) | ExprKind::Builtin(_, list) => parts(list),
            ExprKind::Convert(inner) => is_some_part(inner, holds),
            ExprKind::Swizzle(base, _) | ExprKind::Member(base, _) => is_some_part(base, holds),
            ExprKind::Index(base, index) => either(base, index),
            ExprKind::Ternary(condition, yes, no) => {
                is_some_part(condition, holds) || either(yes, no)
            }
            _ => false,
        }
}

/// Whether WGSL refuses this operation on constants as it is: integers that wrap, shifts that lose
/// bits, results that are not finite.
fn is_refused(expr: &Expr) -> bool {
    let Some(known) = &expr.known else { return false };
    let infinite = |number: &Number| matches!(number, Number::Float(value) if !value.is_finite());
    if known.iter().any(infinite) {
        return true;
    }
    match &expr.kind {
        ExprKind::Binary(op, left, right) => overflows(*op, left, right),
        ExprKind::Unary(Op::Negate, operand) => {
            let least = |number: &Number| *number == Number::Int(i32::MIN);
            operand.known.iter().any(|known| known.iter().any(least))
                || operand.ty.scalar() == Some(Scalar::Uint)
        }
        _ => false,
    }
}

/// The operand that WGSL refuses as a constant, whatever the others are. GLSL leaves the result open
/// there, but takes the text.
pub(super) fn refused_operand(expr: &Expr) -> Option<usize> {
    match &expr.kind {
        ExprKind::Binary(op, left, right) if left.known.is_none() => {
            is_refused_beside(*op, &left.ty, right).then_some(1)
        }
        ExprKind::Builtin(name, arguments) => refused_argument(name, arguments),
        _ => None,
    }
}

/// Whether WGSL refuses an operator for the constant at its right.
pub(super) fn is_refused_beside(op: Op, left: &Type, right: &Expr) -> bool {
    let Some(known) = &right.known else { return false };
    let is_integer = matches!(left.scalar(), Some(Scalar::Int | Scalar::Uint));
    match op {
        Op::ShiftLeft | Op::ShiftRight => known.iter().any(|count| !is_bit(*count)),
        Op::Div | Op::Mod if is_integer => {
            known.iter().any(|number| matches!(number, Number::Int(0) | Number::Uint(0)))
        }
        _ => false,
    }
}

fn is_bit(number: Number) -> bool {
    wide(number).is_some_and(|value| (0..32).contains(&value))
}

fn refused_argument(name: &str, arguments: &[Expr]) -> Option<usize> {
    let known = |index: usize| arguments.get(index)?.known.as_deref();
    let float = |number: Number| match number {
        Number::Float(value) => Some(f64::from(value)),
        other => wide(other).map(|value| value as f64),
    };
    let any = |low: usize, high: usize, holds: &dyn Fn(f64, f64) -> bool| {
        let (Some(a), Some(b)) = (known(low), known(high)) else { return false };
        (0..a.len().max(b.len())).any(|index| {
            let pair = (float(component(a, index)), float(component(b, index)));
            matches!(pair, (Some(a), Some(b)) if holds(a, b))
        })
    };
    let bits = |offset: usize, count: usize| {
        any(offset, count, &|offset, count| offset < 0.0 || count < 0.0 || offset + count > 32.0)
    };
    match name {
        "smoothstep" => any(0, 1, &|low, high| low >= high).then_some(0),
        "clamp" => any(1, 2, &|low, high| low > high).then_some(1),
        "ldexp" => any(1, 1, &|exponent, _| exponent > 128.0).then_some(1),
        "bitfieldExtract" => bits(1, 2).then_some(1),
        "bitfieldInsert" => bits(2, 3).then_some(2),
        _ => None,
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
    (0..count).any(|index| overflows_number(op, component(a, index), component(b, index)))
}

/// A component of a vector, or a number that stands for all of them.
fn component(known: &[Number], index: usize) -> Number {
    known.get(index).or_else(|| known.first()).copied().unwrap_or(Number::Int(0))
}

fn wide(number: Number) -> Option<i64> {
    match number {
        Number::Int(value) => Some(i64::from(value)),
        Number::Uint(value) => Some(i64::from(value)),
        Number::Bool(_) | Number::Float(_) => None,
    }
}

fn overflows_number(op: Op, a: Number, b: Number) -> bool {
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
        Op::ShiftLeft => is_bit(b).then(|| x << y),
        Op::ShiftRight => return !(0..32).contains(&y),
        _ => return false,
    };
    exact.is_none_or(|value| !range.contains(&value))
}
