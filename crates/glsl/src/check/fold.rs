//! What constant expressions are.

use crate::lexer::At;
use crate::tree::{Expr, ExprKind, Known, Number, Op};
use crate::types::{Scalar, Type};

/// An expression with other numbers of the same shape.
pub(crate) fn converted(expr: Expr, to: &Type) -> Expr {
    let known = match (to.scalar(), &expr.known) {
        (Some(scalar), Some(known)) => Some(known.iter().map(|number| number.to(scalar)).collect()),
        _ => None,
    };
    let at = expr.at;
    Expr { kind: ExprKind::Convert(Box::new(expr)), ty: to.clone(), at, known }
}

pub(crate) fn unary(op: Op, operand: Option<&Known>) -> Option<Known> {
    operand?.iter().map(|number| unary_number(op, *number)).collect()
}

fn unary_number(op: Op, number: Number) -> Option<Number> {
    Some(match (op, number) {
        (Op::Negate, Number::Int(value)) => Number::Int(value.wrapping_neg()),
        (Op::Negate, Number::Uint(value)) => Number::Uint(value.wrapping_neg()),
        (Op::Negate, Number::Float(value)) => Number::Float(-value),
        (Op::Not, Number::Bool(value)) => Number::Bool(!value),
        (Op::Invert, Number::Int(value)) => Number::Int(!value),
        (Op::Invert, Number::Uint(value)) => Number::Uint(!value),
        _ => return None,
    })
}

pub(crate) fn logic(is_and: bool, left: &Expr, right: &Expr) -> Option<Known> {
    let value = |expr: &Expr| match expr.known.as_deref() {
        Some([Number::Bool(value)]) => Some(*value),
        _ => None,
    };
    let (left, right) = (value(left)?, value(right)?);
    let result = if is_and { left && right } else { left || right };
    Some([Number::Bool(result)].into())
}

/// A binary expression, with its value if both operands are known.
pub(crate) fn binary_expr(op: Op, left: Expr, right: Expr, ty: Type, at: At) -> Expr {
    let known = binary(op, &left, &right);
    Expr { kind: ExprKind::Binary(op, Box::new(left), Box::new(right)), ty, at, known }
}

fn binary(op: Op, left: &Expr, right: &Expr) -> Option<Known> {
    let (a, b) = (left.known.as_ref()?, right.known.as_ref()?);
    if matches!(op, Op::Equal | Op::NotEqual) {
        let equal = a.len() == b.len() && a.iter().zip(b.iter()).all(|(a, b)| a == b);
        return Some([Number::Bool(equal == (op == Op::Equal))].into());
    }
    if op == Op::Mul && is_product(&left.ty, &right.ty) {
        return product(a, &left.ty, b, &right.ty);
    }
    let count = a.len().max(b.len());
    let at = |known: &Known, index: usize| if known.len() == 1 { known[0] } else { known[index] };
    let fits = |known: &Known| known.len() == 1 || known.len() == count;
    if !fits(a) || !fits(b) {
        return None;
    }
    (0..count).map(|index| binary_number(op, at(a, index), at(b, index))).collect()
}

fn is_product(left: &Type, right: &Type) -> bool {
    let matrix = |ty: &Type| matches!(ty, Type::Matrix(..));
    let scalar = |ty: &Type| matches!(ty, Type::Scalar(_));
    (matrix(left) || matrix(right)) && !scalar(left) && !scalar(right)
}

/// A product of matrices and vectors. A vector on the left is a row.
fn product(a: &Known, left: &Type, b: &Known, right: &Type) -> Option<Known> {
    let size = |ty: &Type, is_left: bool| match ty {
        Type::Matrix(_, columns, rows) => (usize::from(*columns), usize::from(*rows)),
        Type::Vector(_, size) if is_left => (usize::from(*size), 1),
        Type::Vector(_, size) => (1, usize::from(*size)),
        _ => (1, 1),
    };
    let (inner, rows) = size(left, true);
    let (columns, _) = size(right, false);
    let float = |number: Number| match number {
        Number::Float(value) => value,
        _ => 0.0,
    };
    let mut result = Vec::with_capacity(columns * rows);
    for column in 0..columns {
        for row in 0..rows {
            let mut sum = 0.0_f32;
            for k in 0..inner {
                let (x, y) = (a.get(k * rows + row)?, b.get(column * inner + k)?);
                sum += float(*x) * float(*y);
            }
            result.push(Number::Float(sum));
        }
    }
    Some(result.into())
}

pub(crate) fn binary_number(op: Op, a: Number, b: Number) -> Option<Number> {
    match (a, b) {
        (Number::Float(a), Number::Float(b)) => float_op(op, a, b),
        (Number::Int(a), Number::Int(b)) => int_op(op, a, b),
        (Number::Uint(a), Number::Uint(b)) => uint_op(op, a, b),
        (Number::Int(a), Number::Uint(b)) => shift_op(op, a, b).map(Number::Int),
        (Number::Uint(a), Number::Int(b)) => {
            shift_op(op, a as i32, b as u32)?;
            uint_op(op, a, b as u32)
        }
        (Number::Bool(a), Number::Bool(b)) => match op {
            Op::LogicXor => Some(Number::Bool(a != b)),
            _ => None,
        },
        _ => None,
    }
}

fn float_op(op: Op, a: f32, b: f32) -> Option<Number> {
    Some(match op {
        Op::Add => Number::Float(a + b),
        Op::Sub => Number::Float(a - b),
        Op::Mul => Number::Float(a * b),
        Op::Div => Number::Float(a / b),
        Op::Less => Number::Bool(a < b),
        Op::Greater => Number::Bool(a > b),
        Op::LessEqual => Number::Bool(a <= b),
        Op::GreaterEqual => Number::Bool(a >= b),
        _ => return None,
    })
}

fn shift_op(op: Op, a: i32, b: u32) -> Option<i32> {
    match op {
        Op::ShiftLeft => Some(a.wrapping_shl(b)),
        Op::ShiftRight => Some(a.wrapping_shr(b)),
        _ => None,
    }
}

fn int_op(op: Op, a: i32, b: i32) -> Option<Number> {
    Some(match op {
        Op::Add => Number::Int(a.wrapping_add(b)),
        Op::Sub => Number::Int(a.wrapping_sub(b)),
        Op::Mul => Number::Int(a.wrapping_mul(b)),
        // A division by zero has no value.
        Op::Div => Number::Int(a.checked_div(b).unwrap_or(a)),
        Op::Mod => Number::Int(a.checked_rem(b).unwrap_or(0)),
        Op::ShiftLeft | Op::ShiftRight => Number::Int(shift_op(op, a, b as u32)?),
        Op::And => Number::Int(a & b),
        Op::Or => Number::Int(a | b),
        Op::Xor => Number::Int(a ^ b),
        Op::Less => Number::Bool(a < b),
        Op::Greater => Number::Bool(a > b),
        Op::LessEqual => Number::Bool(a <= b),
        Op::GreaterEqual => Number::Bool(a >= b),
        _ => return None,
    })
}

fn uint_op(op: Op, a: u32, b: u32) -> Option<Number> {
    Some(match op {
        Op::Add => Number::Uint(a.wrapping_add(b)),
        Op::Sub => Number::Uint(a.wrapping_sub(b)),
        Op::Mul => Number::Uint(a.wrapping_mul(b)),
        Op::Div => Number::Uint(a.checked_div(b).unwrap_or(a)),
        Op::Mod => Number::Uint(a.checked_rem(b).unwrap_or(0)),
        Op::ShiftLeft => Number::Uint(a.wrapping_shl(b)),
        Op::ShiftRight => Number::Uint(a.wrapping_shr(b)),
        Op::And => Number::Uint(a & b),
        Op::Or => Number::Uint(a | b),
        Op::Xor => Number::Uint(a ^ b),
        Op::Less => Number::Bool(a < b),
        Op::Greater => Number::Bool(a > b),
        Op::LessEqual => Number::Bool(a <= b),
        Op::GreaterEqual => Number::Bool(a >= b),
        _ => return None,
    })
}

/// The numbers of what a constructor makes.
pub(crate) fn constructed(ty: &Type, arguments: &[Expr]) -> Option<Known> {
    let mut numbers = Vec::new();
    for argument in arguments {
        numbers.extend(argument.known.as_ref()?.iter().copied());
    }
    let Some(scalar) = ty.scalar() else { return Some(numbers.into()) };
    let convert = |number: &Number| number.to(scalar);
    let count = ty.components() as usize;
    if let (Type::Matrix(_, columns, rows), [only]) = (ty, arguments) {
        return matrix_from(only, numbers, (*columns, *rows), scalar);
    }
    if numbers.len() == 1 {
        return Some(vec![convert(numbers.first()?); count].into());
    }
    (numbers.len() >= count).then(|| numbers[..count].iter().map(convert).collect())
}

fn matrix_from(
    only: &Expr,
    numbers: Vec<Number>,
    (columns, rows): (u8, u8),
    scalar: Scalar,
) -> Option<Known> {
    let (zero, one) = (Number::Float(0.0), Number::Float(1.0));
    let (from, diagonal) = match only.ty {
        Type::Scalar(_) => ((0, 0), *numbers.first()?),
        Type::Matrix(_, columns, rows) => ((columns, rows), one),
        _ => return Some(numbers.iter().map(|number| number.to(scalar)).collect()),
    };
    let mut result = Vec::new();
    for column in 0..columns {
        for row in 0..rows {
            let inside = column < from.0 && row < from.1;
            let index = usize::from(column) * usize::from(from.1) + usize::from(row);
            let other = if column == row { diagonal } else { zero };
            result.push(if inside { *numbers.get(index)? } else { other }.to(scalar));
        }
    }
    Some(result.into())
}

/// One part of a value: some of its numbers.
pub(crate) fn part(known: Option<&Known>, start: usize, count: usize) -> Option<Known> {
    known?.get(start..start + count).map(Into::into)
}
