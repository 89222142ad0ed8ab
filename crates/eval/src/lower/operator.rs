//! Lowers operators and conversions.

use super::{Loc, LoweredBody};
use crate::code::{
    Binary, Compare, Convert, Instruction, Operand, Product, Slot, Unary, Word1, Word2,
};
use crate::error::Error;
use crate::layout::SlotKind;
use naga::{
    BinaryOperator, Expression, Handle, RelationalFunction, ScalarKind, TypeInner, UnaryOperator,
};

/// An operator with its operations on floats, on signed and on unsigned integers. `None` where
/// there is none here: comparisons of floats are in [`comparison_of`]. `>` and `>=` have the
/// operations of `<` and `<=`, with swapped operands.
type OperatorMeaning = (BinaryOperator, Option<Binary>, Option<Word2>, Option<Word2>);

const MEANINGS: &[OperatorMeaning] = &[
    (BinaryOperator::Add, Some(Binary::Add), Some(Word2::Add), Some(Word2::Add)),
    (
        BinaryOperator::Subtract,
        Some(Binary::Subtract),
        Some(Word2::Subtract),
        Some(Word2::Subtract),
    ),
    (
        BinaryOperator::Multiply,
        Some(Binary::Multiply),
        Some(Word2::Multiply),
        Some(Word2::Multiply),
    ),
    (BinaryOperator::Divide, Some(Binary::Divide), Some(Word2::DivideS), Some(Word2::DivideU)),
    (
        BinaryOperator::Modulo,
        Some(Binary::Remainder),
        Some(Word2::RemainderS),
        Some(Word2::RemainderU),
    ),
    (BinaryOperator::And, None, Some(Word2::And), Some(Word2::And)),
    (BinaryOperator::LogicalAnd, None, None, Some(Word2::And)),
    (BinaryOperator::InclusiveOr, None, Some(Word2::Or), Some(Word2::Or)),
    (BinaryOperator::LogicalOr, None, None, Some(Word2::Or)),
    (BinaryOperator::ExclusiveOr, None, Some(Word2::Xor), Some(Word2::Xor)),
    (BinaryOperator::ShiftLeft, None, Some(Word2::ShiftLeft), Some(Word2::ShiftLeft)),
    (BinaryOperator::ShiftRight, None, Some(Word2::ShiftRightS), Some(Word2::ShiftRightU)),
    (BinaryOperator::Equal, None, Some(Word2::Equal), Some(Word2::Equal)),
    (BinaryOperator::NotEqual, None, Some(Word2::NotEqual), Some(Word2::NotEqual)),
    (BinaryOperator::Less, None, Some(Word2::LessS), Some(Word2::LessU)),
    (BinaryOperator::LessEqual, None, Some(Word2::LessEqualS), Some(Word2::LessEqualU)),
    (BinaryOperator::Greater, None, Some(Word2::LessS), Some(Word2::LessU)),
    (BinaryOperator::GreaterEqual, None, Some(Word2::LessEqualS), Some(Word2::LessEqualU)),
];

impl LoweredBody<'_, '_> {
    pub(super) fn unary(
        &mut self,
        handle: Handle<Expression>,
        op: UnaryOperator,
        expr: Handle<Expression>,
    ) -> Result<Loc, Error> {
        let float = self.kind(expr)? == SlotKind::Float;
        match op {
            UnaryOperator::Negate if float => self.float1(handle, Unary::Negate, expr),
            UnaryOperator::Negate => self.word1(handle, Word1::Negate, expr),
            UnaryOperator::LogicalNot => self.word1(handle, Word1::LogicalNot, expr),
            UnaryOperator::BitwiseNot => self.word1(handle, Word1::Not, expr),
        }
    }

    pub(super) fn binary(
        &mut self,
        handle: Handle<Expression>,
        op: BinaryOperator,
        left: Handle<Expression>,
        right: Handle<Expression>,
    ) -> Result<Loc, Error> {
        let kind = self.kind(left)?;
        let product =
            if op == BinaryOperator::Multiply { self.product(handle, left, right)? } else { None };
        if let Some(loc) = product {
            return Ok(loc);
        }
        if let (SlotKind::Float, Some(op)) = (kind, comparison_of(op)) {
            return self.each2(handle, [left, right], |n, to, a, b| Instruction::Compare {
                op,
                n,
                to,
                a,
                b,
            });
        }
        let meaning = MEANINGS.iter().find(|meaning| meaning.0 == op);
        let swapped = matches!(op, BinaryOperator::Greater | BinaryOperator::GreaterEqual);
        match (kind, meaning) {
            (SlotKind::Float, Some((_, Some(op), ..))) => self.float2(handle, *op, left, right),
            (SlotKind::Sint, Some((_, _, Some(op), _))) => {
                self.ordered(handle, *op, left, right, swapped)
            }
            (_, Some((_, _, _, Some(op)))) => self.ordered(handle, *op, left, right, swapped),
            _ => Err(Error::unsupported(format!("the operator `{op:?}` on this type"))),
        }
    }

    fn ordered(
        &mut self,
        handle: Handle<Expression>,
        op: Word2,
        left: Handle<Expression>,
        right: Handle<Expression>,
        swapped: bool,
    ) -> Result<Loc, Error> {
        if swapped {
            self.word2(handle, op, right, left)
        } else {
            self.word2(handle, op, left, right)
        }
    }

    /// Lowers products with a matrix, which are not computed component by component.
    fn product(
        &mut self,
        handle: Handle<Expression>,
        left: Handle<Expression>,
        right: Handle<Expression>,
    ) -> Result<Option<Loc>, Error> {
        let (op, inner, rows, columns) = match (self.inner(left), self.inner(right)) {
            (TypeInner::Matrix { columns, rows, .. }, TypeInner::Vector { .. }) => {
                (Product::MatrixVector, *columns as u8, *rows as u8, 1)
            }
            (TypeInner::Vector { .. }, TypeInner::Matrix { columns, rows, .. }) => {
                (Product::VectorMatrix, *rows as u8, 1, *columns as u8)
            }
            (TypeInner::Matrix { columns, rows, .. }, TypeInner::Matrix { columns: right, .. }) => {
                (Product::MatrixMatrix, *columns as u8, *rows as u8, *right as u8)
            }
            _ => return Ok(None),
        };
        let (a, b) = (self.dense(left)?, self.dense(right)?);
        let (to, _) = self.fresh(handle)?;
        self.emit(Instruction::Product { op, inner, rows, columns, to, a, b });
        Ok(Some(Loc::dense(to, false)))
    }

    /// An instruction for each component of an operand.
    pub(super) fn each1(
        &mut self,
        handle: Handle<Expression>,
        a: Handle<Expression>,
        instruction: impl FnOnce(u8, Slot, Operand) -> Instruction,
    ) -> Result<Loc, Error> {
        let ((to, n), a) = (self.fresh(handle)?, self.operand(a)?);
        self.emit(instruction(n as u8, to, a));
        Ok(Loc::dense(to, false))
    }

    /// An instruction for each pair of components. A scalar is repeated.
    fn each2(
        &mut self,
        handle: Handle<Expression>,
        [a, b]: [Handle<Expression>; 2],
        instruction: impl FnOnce(u8, Slot, Operand, Operand) -> Instruction,
    ) -> Result<Loc, Error> {
        let (to, n) = self.fresh(handle)?;
        let (a, b) = (self.spread(a, n)?, self.spread(b, n)?);
        self.emit(instruction(n as u8, to, a, b));
        Ok(Loc::dense(to, false))
    }

    pub(super) fn float1(
        &mut self,
        handle: Handle<Expression>,
        op: Unary,
        a: Handle<Expression>,
    ) -> Result<Loc, Error> {
        self.each1(handle, a, |n, to, a| Instruction::Float1 { op, n, to, a })
    }

    pub(super) fn float2(
        &mut self,
        handle: Handle<Expression>,
        op: Binary,
        a: Handle<Expression>,
        b: Handle<Expression>,
    ) -> Result<Loc, Error> {
        self.each2(handle, [a, b], |n, to, a, b| Instruction::Float2 { op, n, to, a, b })
    }

    pub(super) fn word1(
        &mut self,
        handle: Handle<Expression>,
        op: Word1,
        a: Handle<Expression>,
    ) -> Result<Loc, Error> {
        self.each1(handle, a, |n, to, a| Instruction::Word1 { op, n, to, a })
    }

    pub(super) fn word2(
        &mut self,
        handle: Handle<Expression>,
        op: Word2,
        a: Handle<Expression>,
        b: Handle<Expression>,
    ) -> Result<Loc, Error> {
        self.each2(handle, [a, b], |n, to, a, b| Instruction::Word2 { op, n, to, a, b })
    }

    pub(super) fn word2_at(&mut self, op: Word2, n: u32, to: Slot, a: Operand, b: Operand) {
        self.emit(Instruction::Word2 { op, n: n as u8, to, a, b });
    }

    pub(super) fn relational(
        &mut self,
        handle: Handle<Expression>,
        fun: RelationalFunction,
        argument: Handle<Expression>,
    ) -> Result<Loc, Error> {
        match fun {
            RelationalFunction::IsNan => self.convert(handle, Convert::IsNan, argument),
            RelationalFunction::IsInf => self.convert(handle, Convert::IsInf, argument),
            RelationalFunction::All | RelationalFunction::Any => {
                let (n, a, (to, _)) =
                    (self.slots(argument)?, self.dense(argument)?, self.fresh(handle)?);
                self.emit(Instruction::Reduce {
                    all: fun == RelationalFunction::All,
                    n: n as u8,
                    to,
                    a,
                });
                Ok(Loc::dense(to, false))
            }
        }
    }

    pub(super) fn cast(
        &mut self,
        handle: Handle<Expression>,
        expr: Handle<Expression>,
        kind: ScalarKind,
        convert: Option<u8>,
    ) -> Result<Loc, Error> {
        let from = self.kind(expr)?;
        if convert.is_some_and(|width| width != 4 && kind != ScalarKind::Bool) {
            return Err(Error::unsupported("conversions to scalars that are not 32 bits wide"));
        }
        match (from, kind, convert.is_some()) {
            (SlotKind::Float, ScalarKind::Float, _) => self.loc(expr),
            (SlotKind::Float, ScalarKind::Sint, true) => {
                self.convert(handle, Convert::SFromFloat, expr)
            }
            (SlotKind::Float, ScalarKind::Uint, true) => {
                self.convert(handle, Convert::UFromFloat, expr)
            }
            (SlotKind::Float, ScalarKind::Bool, _) => {
                self.convert(handle, Convert::BoolFromFloat, expr)
            }
            (SlotKind::Float, _, false) => self.convert(handle, Convert::BitsFromFloat, expr),
            (SlotKind::Sint, ScalarKind::Float, true) => {
                self.convert(handle, Convert::FloatFromS, expr)
            }
            (_, ScalarKind::Float, true) => self.convert(handle, Convert::FloatFromU, expr),
            (_, ScalarKind::Float, false) => self.convert(handle, Convert::FloatFromBits, expr),
            (SlotKind::Sint | SlotKind::Uint, ScalarKind::Bool, _) => {
                self.word1(handle, Word1::Truth, expr)
            }
            _ => self.loc(expr),
        }
    }

    fn convert(
        &mut self,
        handle: Handle<Expression>,
        op: Convert,
        expr: Handle<Expression>,
    ) -> Result<Loc, Error> {
        self.each1(handle, expr, |n, to, a| Instruction::Convert { op, n, to, a })
    }
}

fn comparison_of(op: BinaryOperator) -> Option<Compare> {
    Some(match op {
        BinaryOperator::Equal => Compare::Equal,
        BinaryOperator::NotEqual => Compare::NotEqual,
        BinaryOperator::Less => Compare::Less,
        BinaryOperator::LessEqual => Compare::LessEqual,
        BinaryOperator::Greater => Compare::Greater,
        BinaryOperator::GreaterEqual => Compare::GreaterEqual,
        _ => return None,
    })
}
