//! Numbers that have no size yet: their values, and what becomes of them.
//!
//! WGSL computes constants without a size in 64 bits. GLSL has no such constants. Where a
//! computation in 32 bits gives the same number, the text stays as the author wrote it; elsewhere
//! the number itself is written.

use lamplight_diagnostic::Diagnostic;

use super::global::{GlobalKind, Globals};
use crate::tree::{Binary, Callee, Expression, ExpressionKind, Meaning, Number, NumberValue};
use crate::tree::{Scalar, Type, Unary};
use crate::wesl::untranslated;

/// The value of a constant expression.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Folded {
    Integer(i64),
    Float(f64),
}

impl Folded {
    fn float(self) -> f64 {
        match self {
            Self::Integer(value) => value as f64,
            Self::Float(value) => value,
        }
    }
}

/// The type that a declaration without a type has.
pub fn default_type(ty: &Type) -> Type {
    match ty.scalar() {
        Some(Scalar::AbstractInteger) => ty.with_scalar(Scalar::I32),
        Some(Scalar::AbstractFloat) => ty.with_scalar(Scalar::F32),
        _ => match ty {
            Type::Array(element, count) => {
                Type::Array(Box::new(default_type(element)), count.clone())
            }
            other => other.clone(),
        },
    }
}

/// The value of a number that has no size yet; nothing for everything else.
pub fn fold(value: &Expression, globals: &Globals) -> Option<Folded> {
    let Type::Scalar(Scalar::AbstractInteger | Scalar::AbstractFloat) = value.ty else {
        return None;
    };
    match &value.kind {
        ExpressionKind::Number(number) => Some(match number.value {
            NumberValue::Integer(value) => Folded::Integer(value),
            NumberValue::Float(value) => Folded::Float(value),
        }),
        ExpressionKind::Name(_, Meaning::Item(path)) => {
            globals.items(path).iter().find_map(|global| match &global.kind {
                GlobalKind::Constant { value, .. } => *value,
                _ => None,
            })
        }
        ExpressionKind::Parenthesised(inner) => fold(inner, globals),
        ExpressionKind::Unary(Unary::Negate, inner) => Some(match fold(inner, globals)? {
            Folded::Integer(value) => Folded::Integer(value.checked_neg()?),
            Folded::Float(value) => Folded::Float(-value),
        }),
        ExpressionKind::Unary(Unary::Complement, inner) => match fold(inner, globals)? {
            Folded::Integer(value) => Some(Folded::Integer(!value)),
            Folded::Float(_) => None,
        },
        ExpressionKind::Binary { operator, left, right, .. } => {
            match (fold(left, globals)?, fold(right, globals)?) {
                (Folded::Integer(left), Folded::Integer(right)) => {
                    integers(*operator, left, right).map(Folded::Integer)
                }
                (left, right) => floats(*operator, left.float(), right.float()).map(Folded::Float),
            }
        }
        ExpressionKind::Call { callee: Callee::Builtin(name), arguments, .. } => {
            let values: Option<Vec<Folded>> =
                arguments.iter().map(|argument| fold(&argument.value, globals)).collect();
            function(name, &values?)
        }
        _ => None,
    }
}

fn integers(operator: Binary, left: i64, right: i64) -> Option<i64> {
    match operator {
        Binary::Add => left.checked_add(right),
        Binary::Subtract => left.checked_sub(right),
        Binary::Multiply => left.checked_mul(right),
        Binary::Divide => left.checked_div(right),
        Binary::Remainder => left.checked_rem(right),
        Binary::BitAnd => Some(left & right),
        Binary::BitOr => Some(left | right),
        Binary::BitXor => Some(left ^ right),
        Binary::ShiftLeft => left.checked_mul(1_i64.checked_shl(u32::try_from(right).ok()?)?),
        Binary::ShiftRight => left.checked_shr(u32::try_from(right).ok()?),
        _ => None,
    }
}

fn floats(operator: Binary, left: f64, right: f64) -> Option<f64> {
    let value = match operator {
        Binary::Add => left + right,
        Binary::Subtract => left - right,
        Binary::Multiply => left * right,
        Binary::Divide => left / right,
        Binary::Remainder => left % right,
        _ => return None,
    };
    value.is_finite().then_some(value)
}

/// Functions whose results are exact, or the nearest float.
fn function(name: &str, values: &[Folded]) -> Option<Folded> {
    if let (true, [Folded::Integer(left), Folded::Integer(right)]) =
        (matches!(name, "min" | "max"), values)
    {
        let value = if name == "min" { left.min(right) } else { left.max(right) };
        return Some(Folded::Integer(*value));
    }
    let floats: Vec<f64> = values.iter().map(|value| value.float()).collect();
    let value = match (name, floats.as_slice()) {
        ("min", [left, right]) => left.min(*right),
        ("max", [left, right]) => left.max(*right),
        ("abs", [value]) => value.abs(),
        ("sqrt", [value]) => value.sqrt(),
        ("floor", [value]) => value.floor(),
        ("ceil", [value]) => value.ceil(),
        ("trunc", [value]) => value.trunc(),
        _ => return None,
    };
    value.is_finite().then_some(Folded::Float(value))
}

/// Gives an expression that has no size yet a type, as far as that is possible.
pub fn convert(value: &mut Expression, target: &Type, globals: &Globals) -> Result<(), Diagnostic> {
    if value.ty == *target || !value.ty.is_abstract() {
        return Ok(());
    }
    let Some(scalar) = scalar_within(target) else { return Ok(()) };
    let ty = scalar_type(&value.ty, scalar);
    if let Some(folded) = fold(value, globals) {
        return convert_number(value, folded, scalar, ty, globals);
    }
    convert_parts(value, scalar, globals)?;
    value.ty = ty;
    Ok(())
}

/// The scalar that a type is made of in the end.
fn scalar_within(ty: &Type) -> Option<Scalar> {
    match ty {
        Type::Array(element, _) => scalar_within(element),
        other => other.scalar(),
    }
}

fn scalar_type(ty: &Type, scalar: Scalar) -> Type {
    ty.with_scalar(scalar)
}

/// A scalar whose value is known.
fn convert_number(
    value: &mut Expression,
    folded: Folded,
    scalar: Scalar,
    ty: Type,
    globals: &Globals,
) -> Result<(), Diagnostic> {
    let refused = || untranslated(value.span, format!("a number that is not one of {scalar}"));
    let exact = match (scalar, folded) {
        (Scalar::F32, folded) => NumberValue::Float(f64::from(folded.float() as f32)),
        (Scalar::I32, Folded::Integer(number)) => {
            NumberValue::Integer(i64::from(i32::try_from(number).map_err(|_| refused())?))
        }
        (Scalar::U32, Folded::Integer(number)) => {
            NumberValue::Integer(i64::from(u32::try_from(number).map_err(|_| refused())?))
        }
        (Scalar::AbstractFloat, Folded::Integer(_) | Folded::Float(_)) => {
            value.ty = ty;
            return Ok(());
        }
        _ => return Err(refused()),
    };
    let stays = match value.kind {
        ExpressionKind::Number(_) => true,
        // The least integer has a number in it that is none of its type.
        _ => {
            !matches!((scalar, exact), (Scalar::I32, NumberValue::Integer(number)) if number == i64::from(i32::MIN))
                && stepwise(value, scalar, globals) == Some(exact)
        }
    };
    if stays {
        convert_parts(value, scalar, globals)?;
    } else {
        let text = match exact {
            NumberValue::Integer(number) => number.to_string(),
            NumberValue::Float(number) => format!("{:?}", number as f32),
        };
        value.kind = ExpressionKind::Number(Number { text, value: exact });
    }
    value.ty = ty;
    Ok(())
}

/// The value of an expression if each step has the scalar's size.
fn stepwise(value: &Expression, scalar: Scalar, globals: &Globals) -> Option<NumberValue> {
    let folded = step(value, scalar, globals)?;
    Some(match folded {
        Folded::Integer(value) => NumberValue::Integer(value),
        Folded::Float(value) => NumberValue::Float(value),
    })
}

fn step(value: &Expression, scalar: Scalar, globals: &Globals) -> Option<Folded> {
    let sized = |folded: Folded| match scalar {
        Scalar::F32 => Some(Folded::Float(f64::from(folded.float() as f32))),
        Scalar::I32 => match folded {
            Folded::Integer(value) => {
                i32::try_from(value).ok().map(|value| Folded::Integer(i64::from(value)))
            }
            Folded::Float(_) => None,
        },
        Scalar::U32 => match folded {
            Folded::Integer(value) => {
                u32::try_from(value).ok().map(|value| Folded::Integer(i64::from(value)))
            }
            Folded::Float(_) => None,
        },
        _ => None,
    };
    match &value.kind {
        ExpressionKind::Parenthesised(inner) => step(inner, scalar, globals),
        ExpressionKind::Unary(Unary::Negate, inner) => sized(match step(inner, scalar, globals)? {
            Folded::Integer(value) => Folded::Integer(-value),
            Folded::Float(value) => Folded::Float(-value),
        }),
        ExpressionKind::Binary { operator, left, right, .. } => {
            let (left, right) = (step(left, scalar, globals)?, step(right, scalar, globals)?);
            sized(match (left, right) {
                (Folded::Integer(left), Folded::Integer(right)) => {
                    Folded::Integer(integers(*operator, left, right)?)
                }
                (left, right) => Folded::Float(floats(*operator, left.float(), right.float())?),
            })
        }
        ExpressionKind::Number(_) | ExpressionKind::Name(..) => sized(fold(value, globals)?),
        _ => None,
    }
}

/// Gives the parts of an expression the scalar.
fn convert_parts(
    value: &mut Expression,
    scalar: Scalar,
    globals: &Globals,
) -> Result<(), Diagnostic> {
    let span = value.span;
    let target = Type::Scalar(scalar);
    match &mut value.kind {
        ExpressionKind::Number(_) => Ok(()),
        ExpressionKind::Parenthesised(inner)
        | ExpressionKind::Unary(_, inner)
        | ExpressionKind::Member(inner, _)
        | ExpressionKind::Index(inner, _) => convert(inner, &target, globals),
        ExpressionKind::Binary { left, right, .. } => {
            convert(left, &target, globals)?;
            convert(right, &target, globals)
        }
        ExpressionKind::Name(..) | ExpressionKind::Axis(_) => {
            let inner = std::mem::replace(value, Expression::new(ExpressionKind::Bool(true), span));
            value.kind = ExpressionKind::Convert(Box::new(inner));
            Ok(())
        }
        ExpressionKind::Call { callee: Callee::Construct(ty), arguments, .. } => {
            *ty = ty.with_scalar(scalar);
            let mut arguments = arguments.iter_mut();
            arguments.try_for_each(|argument| convert(&mut argument.value, &target, globals))
        }
        ExpressionKind::Call { callee: Callee::Builtin(name), arguments, .. }
            if EXACT.contains(&name.as_str()) =>
        {
            let mut arguments = arguments.iter_mut();
            arguments.try_for_each(|argument| convert(&mut argument.value, &target, globals))
        }
        _ => Err(untranslated(span, "a constant that is computed with more digits than f32 has")),
    }
}

/// Functions that give the same result in 32 bits, rounded before or after.
const EXACT: [&str; 10] =
    ["abs", "all", "any", "ceil", "clamp", "floor", "max", "min", "select", "trunc"];
