//! Abstract numbers, as the specification of WGSL calls them: their values, and what becomes of them.
//!
//! WGSL computes abstract constants in 64 bits. GLSL has none. Where a computation in 32 bits gives
//! the same number, the text stays as the author wrote it; elsewhere the number itself is written.

use lamplight_diagnostic::Diagnostic;
use lamplight_diagnostic::source::Span;

use super::global::Globals;
use crate::tree::NumberValue;
use crate::tree::{Argument, Binary, Callee, Expression, ExpressionKind, Meaning, Number};
use crate::tree::{Scalar, Type, Unary};
use crate::wesl::untranslated;

/// The value of a constant expression.
#[derive(Debug, Clone, Copy)]
pub enum Folded {
    Integer(i64),
    Float(f64),
}

impl PartialEq for Folded {
    /// Whether both are the same number: the zeros are two.
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Integer(left), Self::Integer(right)) => left == right,
            (Self::Float(left), Self::Float(right)) => left.to_bits() == right.to_bits(),
            _ => false,
        }
    }
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

/// The value of an abstract number; nothing for everything else.
pub fn fold(value: &Expression, globals: &Globals) -> Option<Folded> {
    let Type::Scalar(_) = value.ty else { return None };
    fold_all(value, globals)?.first().copied()
}

/// The values of the components of an abstract scalar or vector.
pub fn fold_all(value: &Expression, globals: &Globals) -> Option<Vec<Folded>> {
    evaluate(value, globals, &Some)
}

/// The values of the components of an expression that is abstract, each step rounded.
fn evaluate(
    value: &Expression,
    globals: &Globals,
    round: &dyn Fn(Folded) -> Option<Folded>,
) -> Option<Vec<Folded>> {
    let (Type::Scalar(scalar) | Type::Vector(_, scalar)) = value.ty else { return None };
    let of = |one: &Expression| evaluate(one, globals, round);
    let found: Vec<Option<Folded>> = match (&value.kind, scalar) {
        (_, Scalar::Bool | Scalar::I32 | Scalar::U32 | Scalar::F32) => return None,
        (ExpressionKind::Number(number), _) => vec![Some(match number.value {
            NumberValue::Integer(value) => Folded::Integer(value),
            NumberValue::Float(value) => Folded::Float(value),
        })],
        (ExpressionKind::Name(_, Meaning::Item(path)), _) => {
            globals.constant(path)?.iter().copied().map(Some).collect()
        }
        (ExpressionKind::Parenthesised(inner), _) => return of(inner),
        (ExpressionKind::Unary(operator, inner), _) => {
            of(inner)?.into_iter().map(|one| unary(*operator, one)).collect()
        }
        (ExpressionKind::Binary { operator, left, right, .. }, _) => {
            let operate = |pair: Vec<Folded>| binary(*operator, pair[0], pair[1]);
            spread(vec![of(left)?, of(right)?])?.into_iter().map(operate).collect()
        }
        (ExpressionKind::Call { callee: Callee::Builtin(name), arguments, .. }, _) => {
            let all: Option<Vec<_>> = arguments.iter().map(|one| of(&one.value)).collect();
            spread(all?)?.into_iter().map(|values| function(name, &values)).collect()
        }
        (ExpressionKind::Call { callee: Callee::Construct(Type::Vector(size, _)), .. }, _) => {
            constructed(value, *size, &of)?
        }
        (ExpressionKind::Member(object, name), _) => {
            let object = of(object)?;
            let places = name.chars().map(|one| "xyzwrgba".find(one).map(|at| at % 4));
            places.map(|at| object.get(at?).copied()).collect()
        }
        _ => return None,
    };
    let rounded = found.into_iter().map(|one| match (one?, scalar) {
        (Folded::Integer(value), Scalar::AbstractFloat) => round(Folded::Float(value as f64)),
        (one, _) => round(one),
    });
    rounded.collect()
}

/// The components of a vector that is made of its parts.
fn constructed(
    value: &Expression,
    size: u8,
    of: &dyn Fn(&Expression) -> Option<Vec<Folded>>,
) -> Option<Vec<Option<Folded>>> {
    let ExpressionKind::Call { arguments, .. } = &value.kind else { return None };
    let parts: Option<Vec<_>> = arguments.iter().map(|one| of(&one.value)).collect();
    let parts = parts?.concat();
    let size = usize::from(size);
    match parts.len() {
        1 => Some(vec![parts.first().copied(); size]),
        count => (count == size).then(|| parts.into_iter().map(Some).collect()),
    }
}

/// The operands of each component: a scalar is one of every component.
fn spread(operands: Vec<Vec<Folded>>) -> Option<Vec<Vec<Folded>>> {
    let count = operands.iter().map(Vec::len).max()?;
    let at =
        |one: &Vec<Folded>, index: usize| one.get(if one.len() == 1 { 0 } else { index }).copied();
    (0..count).map(|index| operands.iter().map(|one| at(one, index)).collect()).collect()
}

fn unary(operator: Unary, value: Folded) -> Option<Folded> {
    match (operator, value) {
        (Unary::Negate, Folded::Integer(value)) => value.checked_neg().map(Folded::Integer),
        (Unary::Negate, Folded::Float(value)) => Some(Folded::Float(-value)),
        (Unary::Complement, Folded::Integer(value)) => Some(Folded::Integer(!value)),
        _ => None,
    }
}

fn binary(operator: Binary, left: Folded, right: Folded) -> Option<Folded> {
    match (left, right) {
        (Folded::Integer(left), Folded::Integer(right)) => {
            integers(operator, left, right).map(Folded::Integer)
        }
        (left, right) => floats(operator, left.float(), right.float()).map(Folded::Float),
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

/// Gives an abstract expression a type, as far as that is possible.
pub fn convert(value: &mut Expression, target: &Type, globals: &Globals) -> Result<(), Diagnostic> {
    if value.ty == *target || !value.ty.is_abstract() {
        return Ok(());
    }
    let Some(scalar) = scalar_within(target) else { return Ok(()) };
    let ty = value.ty.with_scalar(scalar);
    match fold_all(value, globals) {
        Some(known) => convert_known(value, &known, scalar, globals)?,
        None if is_whole_number(value) && scalar != Scalar::I32 => {
            convert_whole(value, &ty, globals)?
        }
        None => convert_unknown(value, scalar, globals)?,
    }
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

/// A scalar or a vector whose components are known.
fn convert_known(
    value: &mut Expression,
    known: &[Folded],
    scalar: Scalar,
    globals: &Globals,
) -> Result<(), Diagnostic> {
    if scalar == Scalar::AbstractFloat {
        return Ok(());
    }
    let refused = || untranslated(value.span, format!("a number that is not one of {scalar}"));
    let exact: Option<Vec<Folded>> = known.iter().map(|one| sized(*one, scalar)).collect();
    let exact = exact.ok_or_else(refused)?;
    // The least integer has a number in it that is none of its type.
    let is_least = |one: &Folded| *one == Folded::Integer(i64::from(i32::MIN));
    let stays = match value.kind {
        ExpressionKind::Number(_) => true,
        _ => {
            !exact.iter().any(is_least)
                && !calls_function(value)
                && evaluate(value, globals, &|one| sized(one, scalar)).as_ref() == Some(&exact)
        }
    };
    if stays {
        return convert_parts(value, scalar, globals);
    }
    let span = value.span;
    let mut numbers = exact.into_iter().map(|one| number_of(one, scalar, span));
    value.kind = match (&value.ty, numbers.len()) {
        (Type::Vector(size, _), _) => ExpressionKind::Call {
            callee: Callee::Construct(Type::Vector(*size, scalar)),
            arguments: numbers.map(|value| Argument { value, is_on_new_line: false }).collect(),
            is_broken: false,
        },
        _ => numbers.next().map_or(ExpressionKind::Bool(false), |one| one.kind),
    };
    Ok(())
}

fn calls_function(value: &Expression) -> bool {
    let mut found = false;
    value.walk(&mut |part| {
        let ExpressionKind::Call { callee, .. } = &part.kind else { return };
        found |= matches!(callee, Callee::Builtin(_));
    });
    found
}

fn number_of(folded: Folded, scalar: Scalar, span: Span) -> Expression {
    let (text, value) = match folded {
        Folded::Integer(number) => (number.to_string(), NumberValue::Integer(number)),
        Folded::Float(number) => (format!("{:?}", number as f32), NumberValue::Float(number)),
    };
    let kind = ExpressionKind::Number(Number { text, value });
    Expression { kind, ty: Type::Scalar(scalar), span }
}

/// A value as one of a scalar's, if there is such a one.
fn sized(folded: Folded, scalar: Scalar) -> Option<Folded> {
    match (scalar, folded) {
        (Scalar::F32, folded) => Some(Folded::Float(f64::from(folded.float() as f32))),
        (Scalar::I32, Folded::Integer(value)) => i32::try_from(value).ok().map(|_| folded),
        (Scalar::U32, Folded::Integer(value)) => u32::try_from(value).ok().map(|_| folded),
        _ => None,
    }
}

/// Whether a value is a computation with abstract integers. Its parts must not become floats: `7 / 2`
/// is 3.
fn is_whole_number(value: &Expression) -> bool {
    let is_computed = !matches!(value.kind, ExpressionKind::Name(..) | ExpressionKind::Axis(_));
    is_computed && value.ty == Type::Scalar(Scalar::AbstractInteger)
}

/// The same, computed with integers, and then converted.
fn convert_whole(value: &mut Expression, ty: &Type, globals: &Globals) -> Result<(), Diagnostic> {
    convert(value, &Type::I32, globals)?;
    wrap(value);
    value.ty = ty.clone();
    Ok(())
}

/// A value that the axes decide.
fn convert_unknown(
    value: &mut Expression,
    scalar: Scalar,
    globals: &Globals,
) -> Result<(), Diagnostic> {
    let is_float = matches!(scalar, Scalar::F32 | Scalar::AbstractFloat);
    if is_float && matches!(value.kind, ExpressionKind::Binary { .. }) {
        return Err(inexact(value.span));
    }
    convert_parts(value, scalar, globals)
}

fn inexact(span: Span) -> Diagnostic {
    untranslated(span, "a constant that is computed with more digits than f32 has")
        .note("help: give an operand a type, such as `f32(N)`")
}

/// Makes an expression the conversion of itself.
fn wrap(value: &mut Expression) {
    let placeholder = Expression::new(ExpressionKind::Bool(true), value.span);
    let inner = std::mem::replace(value, placeholder);
    value.ty = inner.ty.clone();
    value.kind = ExpressionKind::Convert(Box::new(inner));
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
            wrap(value);
            Ok(())
        }
        // An integer that was to become an abstract float.
        ExpressionKind::Convert(inner) => {
            convert(inner, &target, globals)?;
            let inner =
                std::mem::replace(&mut **inner, Expression::new(ExpressionKind::Bool(true), span));
            *value = inner;
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
        _ => Err(inexact(span)),
    }
}

/// Functions that give the same result in 32 bits, rounded before or after.
const EXACT: [&str; 10] =
    ["abs", "all", "any", "ceil", "clamp", "floor", "max", "min", "select", "trunc"];
