//! Lowers operators, conversions and built-in functions.

use crate::code::{
    Binary, Compare, Convert, Geometry, Instruction, Operand, Packing, Product, Slot, Ternary,
    Unary, Word1, Word2,
};
use crate::error::Error;
use crate::layout::SlotKind;
use crate::lower::{Loc, LoweredBody};
use naga::{
    BinaryOperator, Expression, Handle, MathFunction, RelationalFunction, ScalarKind, TypeInner,
    UnaryOperator,
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

/// A handle of an argument that may be missing.
type Argument = Option<Handle<Expression>>;

/// The instruction that a built-in function becomes for floats.
enum OnFloats {
    One(Unary),
    Two(Binary),
    Three(Ternary),
    Whole(Geometry),
}

impl LoweredBody<'_, '_> {
    pub(super) fn math(
        &mut self,
        handle: Handle<Expression>,
        fun: MathFunction,
        arg: Handle<Expression>,
        rest: [Argument; 3],
    ) -> Result<Loc, Error> {
        if let Some(op) = packing_of(fun) {
            let from = self.dense(arg)?;
            let (to, _) = self.fresh(handle)?;
            self.emit(Instruction::Pack { op, to, from });
            return Ok(Loc::dense(to, false));
        }
        match (self.kind(arg)?, fun) {
            (SlotKind::Float, MathFunction::Outer) => {
                self.outer(handle, arg, required_argument(rest[0])?)
            }
            (SlotKind::Float, MathFunction::Transpose) => self.transpose(handle, arg),
            (SlotKind::Float, _) => self.on_floats(handle, fun, arg, rest),
            (kind, _) => self.on_words(handle, fun, kind == SlotKind::Sint, arg, rest),
        }
    }

    fn on_floats(
        &mut self,
        handle: Handle<Expression>,
        fun: MathFunction,
        arg: Handle<Expression>,
        rest: [Argument; 3],
    ) -> Result<Loc, Error> {
        match on_floats(fun) {
            Some(OnFloats::One(op)) => self.float1(handle, op, arg),
            Some(OnFloats::Two(op)) => self.float2(handle, op, arg, required_argument(rest[0])?),
            Some(OnFloats::Three(op)) => {
                let (to, n) = self.fresh(handle)?;
                let (a, b, c) = (
                    self.spread(arg, n)?,
                    self.spread(required_argument(rest[0])?, n)?,
                    self.spread(required_argument(rest[1])?, n)?,
                );
                self.emit(Instruction::Float3 { op, n: n as u8, to, a, b, c });
                Ok(Loc::dense(to, false))
            }
            Some(OnFloats::Whole(op)) => self.geometry(handle, op, arg, rest),
            None => Err(Error::unsupported(format!("the function `{fun:?}`"))),
        }
    }

    fn geometry(
        &mut self,
        handle: Handle<Expression>,
        op: Geometry,
        arg: Handle<Expression>,
        rest: [Argument; 3],
    ) -> Result<Loc, Error> {
        let n = match *self.inner(arg) {
            TypeInner::Matrix { columns, .. } => columns as u32,
            _ => self.slots(arg)?,
        };
        let a = self.dense(arg)?;
        let b = rest[0].map_or(Ok(a), |arg| self.dense(arg))?;
        let c = rest[1].map_or(Ok(a), |arg| self.dense(arg))?;
        let (to, _) = self.fresh(handle)?;
        self.emit(Instruction::Geometry { op, n: n as u8, to, a, b, c });
        Ok(Loc::dense(to, false))
    }

    fn outer(
        &mut self,
        handle: Handle<Expression>,
        left: Handle<Expression>,
        right: Handle<Expression>,
    ) -> Result<Loc, Error> {
        let (rows, columns) = (self.slots(left)? as u8, self.slots(right)? as u8);
        let (a, b) = (self.dense(left)?, self.dense(right)?);
        let (to, _) = self.fresh(handle)?;
        self.emit(Instruction::Product { op: Product::Outer, inner: 1, rows, columns, to, a, b });
        Ok(Loc::dense(to, false))
    }

    fn transpose(
        &mut self,
        handle: Handle<Expression>,
        arg: Handle<Expression>,
    ) -> Result<Loc, Error> {
        let TypeInner::Matrix { columns, rows, .. } = *self.inner(arg) else {
            return self.loc(arg);
        };
        let from = self.dense(arg)?;
        let (to, _) = self.fresh(handle)?;
        self.emit(Instruction::Transpose { rows: rows as u8, columns: columns as u8, to, from });
        Ok(Loc::dense(to, false))
    }

    fn on_words(
        &mut self,
        handle: Handle<Expression>,
        fun: MathFunction,
        signed: bool,
        arg: Handle<Expression>,
        rest: [Argument; 3],
    ) -> Result<Loc, Error> {
        let (min, max) =
            if signed { (Word2::MinS, Word2::MaxS) } else { (Word2::MinU, Word2::MaxU) };
        match fun {
            MathFunction::Abs if !signed => self.loc(arg),
            MathFunction::Min => self.word2(handle, min, arg, required_argument(rest[0])?),
            MathFunction::Max => self.word2(handle, max, arg, required_argument(rest[0])?),
            MathFunction::Clamp => self.clamp(
                handle,
                arg,
                required_argument(rest[0])?,
                required_argument(rest[1])?,
                (min, max),
            ),
            MathFunction::Dot => self.geometry(handle, Geometry::DotWord, arg, rest),
            MathFunction::Dot4I8Packed => {
                self.word2(handle, Word2::DotBytesS, arg, required_argument(rest[0])?)
            }
            MathFunction::Dot4U8Packed => {
                self.word2(handle, Word2::DotBytesU, arg, required_argument(rest[0])?)
            }
            MathFunction::ExtractBits | MathFunction::InsertBits => {
                self.bits(handle, fun, signed, arg, rest)
            }
            _ => match word1(fun, signed) {
                Some(op) => self.word1(handle, op, arg),
                None => Err(Error::unsupported(format!("the function `{fun:?}` on integers"))),
            },
        }
    }

    fn clamp(
        &mut self,
        handle: Handle<Expression>,
        arg: Handle<Expression>,
        low: Handle<Expression>,
        high: Handle<Expression>,
        (min, max): (Word2, Word2),
    ) -> Result<Loc, Error> {
        let (to, n) = self.fresh(handle)?;
        let raised = self.build.alloc(n)?;
        let (a, low, high) = (self.spread(arg, n)?, self.spread(low, n)?, self.spread(high, n)?);
        self.word2_at(max, n, raised, a, low);
        self.word2_at(min, n, to, Operand { slot: raised, stride: 1 }, high);
        Ok(Loc::dense(to, false))
    }

    fn bits(
        &mut self,
        handle: Handle<Expression>,
        fun: MathFunction,
        signed: bool,
        arg: Handle<Expression>,
        rest: [Argument; 3],
    ) -> Result<Loc, Error> {
        let (to, n) = self.fresh(handle)?;
        let (from, n) = (self.operand(arg)?, n as u8);
        let (first, second) = (
            self.operand(required_argument(rest[0])?)?,
            self.operand(required_argument(rest[1])?)?.slot,
        );
        let instruction = match rest[2] {
            Some(count) if fun == MathFunction::InsertBits => {
                let count = self.operand(count)?.slot;
                Instruction::InsertBits { n, to, from, new: first, offset: second, count }
            }
            _ => {
                Instruction::ExtractBits { signed, n, to, from, offset: first.slot, count: second }
            }
        };
        self.emit(instruction);
        Ok(Loc::dense(to, false))
    }
}

fn required_argument(argument: Argument) -> Result<Handle<Expression>, Error> {
    argument.ok_or_else(|| Error::unsupported("a call with too few arguments"))
}

fn on_floats(fun: MathFunction) -> Option<OnFloats> {
    use OnFloats::{One, Three, Two, Whole};
    if let Some(op) = unary_function(fun) {
        return Some(One(op));
    }
    Some(match fun {
        MathFunction::Min => Two(Binary::Min),
        MathFunction::Max => Two(Binary::Max),
        MathFunction::Clamp => Three(Ternary::Clamp),
        MathFunction::Atan2 => Two(Binary::Atan2),
        MathFunction::Modf => Whole(Geometry::Modf),
        MathFunction::Frexp => Whole(Geometry::Frexp),
        MathFunction::Ldexp => Whole(Geometry::Ldexp),
        MathFunction::Pow => Two(Binary::Pow),
        MathFunction::Dot => Whole(Geometry::Dot),
        MathFunction::Cross => Whole(Geometry::Cross),
        MathFunction::Distance => Whole(Geometry::Distance),
        MathFunction::Length => Whole(Geometry::Length),
        MathFunction::Normalize => Whole(Geometry::Normalize),
        MathFunction::FaceForward => Whole(Geometry::FaceForward),
        MathFunction::Reflect => Whole(Geometry::Reflect),
        MathFunction::Refract => Whole(Geometry::Refract),
        MathFunction::Fma => Three(Ternary::Fma),
        MathFunction::Mix => Three(Ternary::Mix),
        MathFunction::Step => Two(Binary::Step),
        MathFunction::SmoothStep => Three(Ternary::SmoothStep),
        MathFunction::Inverse => Whole(Geometry::Inverse),
        MathFunction::Determinant => Whole(Geometry::Determinant),
        _ => return None,
    })
}

/// The functions of one float.
fn unary_function(fun: MathFunction) -> Option<Unary> {
    Some(match fun {
        MathFunction::Abs => Unary::Abs,
        MathFunction::Saturate => Unary::Saturate,
        MathFunction::Cos => Unary::Cos,
        MathFunction::Cosh => Unary::Cosh,
        MathFunction::Sin => Unary::Sin,
        MathFunction::Sinh => Unary::Sinh,
        MathFunction::Tan => Unary::Tan,
        MathFunction::Tanh => Unary::Tanh,
        MathFunction::Acos => Unary::Acos,
        MathFunction::Asin => Unary::Asin,
        MathFunction::Atan => Unary::Atan,
        MathFunction::Asinh => Unary::Asinh,
        MathFunction::Acosh => Unary::Acosh,
        MathFunction::Atanh => Unary::Atanh,
        MathFunction::Radians => Unary::Radians,
        MathFunction::Degrees => Unary::Degrees,
        MathFunction::Ceil => Unary::Ceil,
        MathFunction::Floor => Unary::Floor,
        MathFunction::Round => Unary::Round,
        MathFunction::Fract => Unary::Fract,
        MathFunction::Trunc => Unary::Trunc,
        MathFunction::Exp => Unary::Exp,
        MathFunction::Exp2 => Unary::Exp2,
        MathFunction::Log => Unary::Log,
        MathFunction::Log2 => Unary::Log2,
        MathFunction::Sign => Unary::Sign,
        MathFunction::Sqrt => Unary::Sqrt,
        MathFunction::InverseSqrt => Unary::InverseSqrt,
        MathFunction::QuantizeToF16 => Unary::Quantize,
        _ => return None,
    })
}

fn word1(fun: MathFunction, signed: bool) -> Option<Word1> {
    Some(match fun {
        MathFunction::Abs => Word1::Abs,
        MathFunction::Sign => Word1::Sign,
        MathFunction::CountTrailingZeros => Word1::TrailingZeros,
        MathFunction::CountLeadingZeros => Word1::LeadingZeros,
        MathFunction::CountOneBits => Word1::CountOnes,
        MathFunction::ReverseBits => Word1::Reverse,
        MathFunction::FirstTrailingBit => Word1::FirstTrailing,
        MathFunction::FirstLeadingBit if signed => Word1::FirstLeadingSigned,
        MathFunction::FirstLeadingBit => Word1::FirstLeading,
        _ => return None,
    })
}

fn packing_of(fun: MathFunction) -> Option<Packing> {
    Some(match fun {
        MathFunction::Pack4x8snorm => Packing::Pack4Snorm8,
        MathFunction::Pack4x8unorm => Packing::Pack4Unorm8,
        MathFunction::Pack2x16snorm => Packing::Pack2Snorm16,
        MathFunction::Pack2x16unorm => Packing::Pack2Unorm16,
        MathFunction::Pack2x16float => Packing::Pack2Half,
        MathFunction::Pack4xI8 | MathFunction::Pack4xU8 => Packing::Pack4,
        MathFunction::Pack4xI8Clamp => Packing::PackClampS,
        MathFunction::Pack4xU8Clamp => Packing::PackClampU,
        MathFunction::Unpack4x8snorm => Packing::Unpack4Snorm8,
        MathFunction::Unpack4x8unorm => Packing::Unpack4Unorm8,
        MathFunction::Unpack2x16snorm => Packing::Unpack2Snorm16,
        MathFunction::Unpack2x16unorm => Packing::Unpack2Unorm16,
        MathFunction::Unpack2x16float => Packing::Unpack2Half,
        MathFunction::Unpack4xI8 => Packing::Unpack4S,
        MathFunction::Unpack4xU8 => Packing::Unpack4U,
        _ => return None,
    })
}
