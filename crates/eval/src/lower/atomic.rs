//! Lowers what only compute shaders have: barriers and atomic functions.
//!
//! An invocation runs alone from one barrier to the next, so that several instructions are atomic.

use super::{Loc, LoweredBody};
use crate::code::{Instruction, Operand, Slot, Word2};
use crate::error::Error;
use crate::layout::SlotKind;
use naga::{AtomicFunction, Expression, Handle};

impl LoweredBody<'_, '_> {
    pub(super) fn barrier(&mut self) -> Result<(), Error> {
        self.emit(Instruction::Barrier);
        Ok(())
    }

    /// A load between two barriers.
    pub(super) fn uniform_load(
        &mut self,
        pointer: Handle<Expression>,
        result: Handle<Expression>,
    ) -> Result<(), Error> {
        self.barrier()?;
        let loc = self.load(result, pointer)?;
        self.locs[result.index()] = Some(loc);
        self.barrier()
    }

    /// Loads the old value, computes the new one and stores it. The old value is the result.
    pub(super) fn atomic(
        &mut self,
        pointer: Handle<Expression>,
        fun: &AtomicFunction,
        value: Handle<Expression>,
        result: Option<Handle<Expression>>,
    ) -> Result<(), Error> {
        let is_signed = match self.kind(value)? {
            SlotKind::Sint => true,
            SlotKind::Uint => false,
            _ => return Err(Error::unsupported("atomic functions of this type")),
        };
        // The second slot is the member `exchanged` of a compare-exchange.
        let old = self.build.alloc(2)?;
        self.read_word(pointer, old)?;
        let value = self.operand(value)?;
        let a = Operand { slot: old, stride: 1 };
        let new = match *fun {
            AtomicFunction::Exchange { compare: None } => value.slot,
            AtomicFunction::Exchange { compare: Some(wanted) } => {
                let (b, held) = (self.operand(wanted)?, Operand { slot: old + 1, stride: 1 });
                self.emit(Instruction::Word2 { op: Word2::Equal, n: 1, to: old + 1, a, b });
                let to = self.build.alloc(1)?;
                let condition = held;
                self.emit(Instruction::Select { n: 1, to, condition, accept: value, reject: a });
                to
            }
            _ => {
                let (to, op) = (self.build.alloc(1)?, operation(fun, is_signed)?);
                self.emit(Instruction::Word2 { op, n: 1, to, a, b: value });
                to
            }
        };
        self.write_word(pointer, new)?;
        if let Some(result) = result {
            self.locs[result.index()] = Some(Loc::dense(old, false));
        }
        Ok(())
    }

    fn read_word(&mut self, pointer: Handle<Expression>, to: Slot) -> Result<(), Error> {
        let loc = self.loc(pointer)?;
        self.emit(match loc {
            Loc::Place(from) => Instruction::Copy { to, from, n: 1 },
            Loc::Through { slot, offset } => Instruction::Load { to, pointer: slot, offset, n: 1 },
            Loc::Value { operand, constant: _ } => {
                Instruction::Load { to, pointer: operand.slot, offset: 0, n: 1 }
            }
        });
        Ok(())
    }

    fn write_word(&mut self, pointer: Handle<Expression>, from: Slot) -> Result<(), Error> {
        let loc = self.loc(pointer)?;
        self.emit(match loc {
            Loc::Place(to) => Instruction::Copy { to, from, n: 1 },
            Loc::Through { slot, offset } => {
                Instruction::Store { pointer: slot, offset, from, n: 1 }
            }
            Loc::Value { operand, constant: _ } => {
                Instruction::Store { pointer: operand.slot, offset: 0, from, n: 1 }
            }
        });
        Ok(())
    }
}

/// What is done with the old value and the argument.
fn operation(fun: &AtomicFunction, is_signed: bool) -> Result<Word2, Error> {
    Ok(match (fun, is_signed) {
        (AtomicFunction::Add, _) => Word2::Add,
        (AtomicFunction::Subtract, _) => Word2::Subtract,
        (AtomicFunction::And, _) => Word2::And,
        (AtomicFunction::ExclusiveOr, _) => Word2::Xor,
        (AtomicFunction::InclusiveOr, _) => Word2::Or,
        (AtomicFunction::Min, true) => Word2::MinS,
        (AtomicFunction::Min, false) => Word2::MinU,
        (AtomicFunction::Max, true) => Word2::MaxS,
        (AtomicFunction::Max, false) => Word2::MaxU,
        (AtomicFunction::Exchange { compare: _ }, _) => {
            return Err(Error::unsupported("this exchange"));
        }
    })
}
