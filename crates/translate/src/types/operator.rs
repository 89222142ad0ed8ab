//! Types of binary operators.

use lamplight_diagnostic::Diagnostic;
use lamplight_diagnostic::source::Span;

use super::constant::{convert, default_type};
use super::expression::mismatch;
use super::scope::Scope;
use crate::tree::{Binary, Expression, Scalar, Type};

impl Scope<'_> {
    /// The type of a binary operator's result. Numbers without a size get that of the other side.
    pub fn binary(
        &mut self,
        operator: Binary,
        left: &mut Expression,
        right: &mut Expression,
        span: Span,
    ) -> Result<Type, Diagnostic> {
        if matches!(operator, Binary::ShiftLeft | Binary::ShiftRight) {
            return self.shift(left, right, span);
        }
        if matches!(operator, Binary::And | Binary::Or) {
            self.fit(left, &Type::BOOL)?;
            self.fit(right, &Type::BOOL)?;
            return Ok(Type::BOOL);
        }
        self.unify(&mut [left, right])?;
        if let Type::Array(element, _) = &left.ty {
            return Err(mismatch(span, format!("operators do not take arrays of {element}")));
        }
        let wrong = || {
            let sign = operator.spelling().0;
            mismatch(span, format!("`{sign}` does not take {} and {}", left.ty, right.ty))
        };
        let (Some(of_left), Some(of_right)) = (left.ty.scalar(), right.ty.scalar()) else {
            return Err(wrong());
        };
        if of_left != of_right {
            return Err(wrong());
        }
        if operator.compares() {
            let fits = left.ty == right.ty && !matches!(left.ty, Type::Matrix { .. });
            return if fits { Ok(left.ty.with_scalar(Scalar::Bool)) } else { Err(wrong()) };
        }
        match operator {
            Binary::BitAnd | Binary::BitOr | Binary::BitXor => {
                let is_float = matches!(of_left, Scalar::F32 | Scalar::AbstractFloat);
                let fits = !is_float && left.ty == right.ty;
                if fits { Ok(left.ty.clone()) } else { Err(wrong()) }
            }
            Binary::Multiply => product(&left.ty, &right.ty).ok_or_else(wrong),
            _ if of_left == Scalar::Bool => Err(wrong()),
            _ => match (&left.ty, &right.ty) {
                (left, right) if left == right => Ok(left.clone()),
                (vector @ Type::Vector(..), Type::Scalar(_))
                | (Type::Scalar(_), vector @ Type::Vector(..)) => Ok(vector.clone()),
                _ => Err(wrong()),
            },
        }
    }

    fn shift(
        &mut self,
        left: &mut Expression,
        right: &mut Expression,
        span: Span,
    ) -> Result<Type, Diagnostic> {
        let count = right.ty.with_scalar(Scalar::U32);
        self.fit(right, &count)?;
        if !matches!(left.ty.scalar(), Some(Scalar::AbstractInteger | Scalar::I32 | Scalar::U32)) {
            return Err(mismatch(span, format!("{} cannot be shifted", left.ty)));
        }
        let ty = default_type(&left.ty);
        convert(left, &ty, self.globals)?;
        Ok(ty)
    }

    /// Gives numbers without a size the scalar of the others, or the widest one of all.
    pub fn unify(&self, values: &mut [&mut Expression]) -> Result<(), Diagnostic> {
        let scalars: Vec<Scalar> = values.iter().filter_map(|value| value.ty.scalar()).collect();
        let is_open =
            |scalar: &Scalar| matches!(scalar, Scalar::AbstractInteger | Scalar::AbstractFloat);
        let target = match scalars.iter().find(|scalar| !is_open(scalar)) {
            Some(sized) => *sized,
            None if scalars.contains(&Scalar::AbstractFloat) => Scalar::AbstractFloat,
            None => return Ok(()),
        };
        for value in values.iter_mut().filter(|value| value.ty.is_abstract()) {
            let ty = value.ty.with_scalar(target);
            convert(value, &ty, self.globals)?;
        }
        Ok(())
    }
}

/// The type of a product in the sense of linear algebra.
fn product(left: &Type, right: &Type) -> Option<Type> {
    match (left, right) {
        (Type::Scalar(Scalar::Bool) | Type::Vector(_, Scalar::Bool), _) => None,
        (Type::Scalar(_), other) | (other, Type::Scalar(_)) => Some(other.clone()),
        (Type::Vector(left_size, scalar), Type::Vector(right_size, _)) => {
            (left_size == right_size).then_some(Type::Vector(*left_size, *scalar))
        }
        (Type::Matrix { columns, rows, scalar }, Type::Vector(size, _)) => {
            (columns == size).then_some(Type::Vector(*rows, *scalar))
        }
        (Type::Vector(size, scalar), Type::Matrix { columns, rows, .. }) => {
            (rows == size).then_some(Type::Vector(*columns, *scalar))
        }
        (
            Type::Matrix { columns, rows, scalar },
            Type::Matrix { columns: right_columns, rows: right_rows, .. },
        ) => (columns == right_rows).then_some(Type::Matrix {
            columns: *right_columns,
            rows: *rows,
            scalar: *scalar,
        }),
        _ => None,
    }
}
