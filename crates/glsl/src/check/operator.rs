//! Operators: which operands they take, and what they give.

use super::{Checker, Res, fold};
use crate::ast;
use crate::lexer::At;
use crate::tree::{Expr, ExprKind, Op};
use crate::types::{BOOL, Scalar, Type};

impl<'a> Checker<'a> {
    /// An expression as another type, if it becomes that type by itself.
    pub(super) fn convert(&self, expr: Expr, to: &Type) -> Result<Expr, Expr> {
        if expr.ty == *to {
            return Ok(expr);
        }
        if !self.version.converts(&expr.ty, to) {
            return Err(expr);
        }
        Ok(fold::converted(expr, to))
    }

    /// An expression as the type of what it is assigned to.
    pub(super) fn convert_to(&mut self, expr: Expr, to: &Type, what: &str) -> Res<Expr> {
        match self.convert(expr, to) {
            Ok(expr) => Ok(expr),
            Err(expr) => {
                let (found, wanted) = (self.type_name(&expr.ty), self.type_name(to));
                self.fail(expr.at, format!("{what} is `{found}` and should be `{wanted}`"))
            }
        }
    }

    pub(super) fn unary(&mut self, text: &str, operand: Expr, at: At) -> Res<Expr> {
        self.check_reserved(text == "~", text, at)?;
        let scalar = operand.ty.scalar();
        let is_matrix = matches!(operand.ty, Type::Matrix(..));
        let op = match (text, scalar) {
            ("-", Some(Scalar::Int | Scalar::Uint | Scalar::Float)) => Op::Negate,
            ("+", Some(Scalar::Int | Scalar::Uint | Scalar::Float)) => return Ok(operand),
            ("!", Some(Scalar::Bool)) if operand.ty == BOOL => Op::Not,
            ("~", Some(Scalar::Int | Scalar::Uint)) if !is_matrix => Op::Invert,
            _ => {
                let name = self.type_name(&operand.ty);
                return self.fail(at, format!("`{text}` does not take `{name}`"));
            }
        };
        let known = fold::unary(op, operand.known.as_ref());
        let ty = operand.ty.clone();
        Ok(Expr { kind: ExprKind::Unary(op, Box::new(operand)), ty, at, known })
    }

    pub(super) fn logic(
        &mut self,
        is_and: bool,
        left: &'a ast::Expr<'a>,
        right: &'a ast::Expr<'a>,
        at: At,
    ) -> Res<Expr> {
        let left = self.bool_expr(left)?;
        let right = self.bool_expr(right)?;
        let known = fold::logic(is_and, &left, &right);
        let kind = ExprKind::Logic(is_and, Box::new(left), Box::new(right));
        Ok(Expr { kind, ty: BOOL, at, known })
    }

    pub(super) fn bool_expr(&mut self, expr: &'a ast::Expr<'a>) -> Res<Expr> {
        let value = self.expr(expr)?;
        if value.ty == BOOL {
            return Ok(value);
        }
        let name = self.type_name(&value.ty);
        self.fail(value.at, format!("a condition is `bool`, and this is `{name}`"))
    }

    /// Operators of whole numbers that GLSL ES 1.00 reserves.
    fn check_reserved(&mut self, is_integer: bool, text: &str, at: At) -> Res<()> {
        match is_integer && self.version.es && self.version.number < 300 {
            true => self.fail(at, format!("`{text}` is reserved in GLSL ES 1.00")),
            false => Ok(()),
        }
    }

    /// A binary operator other than `&&` and `||`.
    pub(super) fn binary(&mut self, op: Op, left: Expr, right: Expr, at: At) -> Res<Expr> {
        use Op::{And, Mod, Or, ShiftLeft, ShiftRight, Xor};
        let is_integer = matches!(op, And | Mod | Or | ShiftLeft | ShiftRight | Xor);
        self.check_reserved(is_integer, op.text(), at)?;
        match op {
            Op::Equal | Op::NotEqual => self.equality(op, left, right, at),
            Op::Less | Op::Greater | Op::LessEqual | Op::GreaterEqual => {
                self.relation(op, left, right, at)
            }
            Op::LogicXor => {
                if left.ty != BOOL || right.ty != BOOL {
                    return self.fail_operands(op, &left, &right, at);
                }
                Ok(fold::binary_expr(op, left, right, BOOL, at))
            }
            Op::ShiftLeft | Op::ShiftRight => self.shift(op, left, right, at),
            Op::And | Op::Or | Op::Xor => {
                let integers = |expr: &Expr| {
                    matches!(expr.ty.as_vector(), Some((Scalar::Int | Scalar::Uint, _)))
                };
                if !integers(&left) || !integers(&right) {
                    return self.fail_operands(op, &left, &right, at);
                }
                self.arithmetic(op, left, right, at)
            }
            _ => self.arithmetic(op, left, right, at),
        }
    }

    fn fail_operands<T>(&mut self, op: Op, left: &Expr, right: &Expr, at: At) -> Res<T> {
        let (left, right) = (self.type_name(&left.ty), self.type_name(&right.ty));
        let text = if op == Op::LogicXor { "^^" } else { op.text() };
        self.fail(at, format!("`{text}` does not take `{left}` and `{right}`"))
    }

    fn equality(&mut self, op: Op, left: Expr, right: Expr, at: At) -> Res<Expr> {
        let same = self.convert(right, &left.ty);
        let (left, right) = match same {
            Ok(right) => (left, right),
            Err(right) => match self.convert(left, &right.ty) {
                Ok(left) => (left, right),
                Err(left) => return self.fail_operands(op, &left, &right, at),
            },
        };
        if left.ty == Type::Void || self.shader.has_opaque(&left.ty) {
            return self.fail_operands(op, &left, &right, at);
        }
        Ok(fold::binary_expr(op, left, right, BOOL, at))
    }

    fn relation(&mut self, op: Op, left: Expr, right: Expr, at: At) -> Res<Expr> {
        let numbers = |expr: &Expr| {
            matches!(expr.ty, Type::Scalar(Scalar::Int | Scalar::Uint | Scalar::Float))
        };
        if !numbers(&left) || !numbers(&right) {
            return self.fail_operands(op, &left, &right, at);
        }
        let (left, right) = self.common_scalar(op, left, right, at)?;
        Ok(fold::binary_expr(op, left, right, BOOL, at))
    }

    fn shift(&mut self, op: Op, left: Expr, right: Expr, at: At) -> Res<Expr> {
        let integer = |expr: &Expr| {
            expr.ty.as_vector().filter(|(s, _)| matches!(s, Scalar::Int | Scalar::Uint))
        };
        match (integer(&left), integer(&right)) {
            (Some((_, size)), Some((_, count))) if count == size || count == 1 => {
                let ty = left.ty.clone();
                Ok(fold::binary_expr(op, left, right, ty, at))
            }
            _ => self.fail_operands(op, &left, &right, at),
        }
    }

    /// Both operands with the same kind of number.
    fn common_scalar(&mut self, op: Op, left: Expr, right: Expr, at: At) -> Res<(Expr, Expr)> {
        let (Some(a), Some(b)) = (left.ty.scalar(), right.ty.scalar()) else {
            return self.fail_operands(op, &left, &right, at);
        };
        if a == b {
            return Ok((left, right));
        }
        let target = left.ty.with_scalar(b);
        if self.version.converts(&left.ty, &target) {
            return Ok((fold::converted(left, &target), right));
        }
        let target = right.ty.with_scalar(a);
        if self.version.converts(&right.ty, &target) {
            return Ok((left, fold::converted(right, &target)));
        }
        self.fail_operands(op, &left, &right, at)
    }

    fn arithmetic(&mut self, op: Op, left: Expr, right: Expr, at: At) -> Res<Expr> {
        let bad = |expr: &Expr| matches!(expr.ty.scalar(), None | Some(Scalar::Bool));
        let float_mod = |expr: &Expr| op == Op::Mod && expr.ty.scalar() == Some(Scalar::Float);
        if bad(&left) || bad(&right) || float_mod(&left) || float_mod(&right) {
            return self.fail_operands(op, &left, &right, at);
        }
        let (left, right) = self.common_scalar(op, left, right, at)?;
        match arithmetic_type(op, &left.ty, &right.ty) {
            Some(ty) => Ok(fold::binary_expr(op, left, right, ty, at)),
            None => self.fail_operands(op, &left, &right, at),
        }
    }
}

/// What an operator gives for operands with the same kind of number.
fn arithmetic_type(op: Op, left: &Type, right: &Type) -> Option<Type> {
    use Type::{Matrix, Scalar, Vector};
    match (left, right) {
        (Scalar(_), Scalar(_) | Vector(..) | Matrix(..)) => Some(right.clone()),
        (Vector(..) | Matrix(..), Scalar(_)) => Some(left.clone()),
        (Vector(_, a), Vector(_, b)) => (a == b).then(|| left.clone()),
        (Matrix(scalar, columns, rows), Vector(_, size)) if op == Op::Mul => {
            (columns == size).then_some(Vector(*scalar, *rows))
        }
        (Vector(scalar, size), Matrix(_, columns, rows)) if op == Op::Mul => {
            (rows == size).then_some(Vector(*scalar, *columns))
        }
        (Matrix(scalar, columns, rows), Matrix(_, others, inner)) if op == Op::Mul => {
            (columns == inner).then_some(Matrix(*scalar, *others, *rows))
        }
        (Matrix(..), Matrix(..)) => (left == right).then(|| left.clone()),
        _ => None,
    }
}
