//! Lowers built-in functions.

use super::{Loc, LoweredBody};
use crate::code::{
    Binary, Geometry, Instruction, Operand, Packing, Product, Ternary, Unary, Word1, Word2,
};
use crate::error::Error;
use crate::layout::SlotKind;
use naga::{Expression, Handle, MathFunction, TypeInner};

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
