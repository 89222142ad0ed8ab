//! Lowers a body: what the lowering of all expressions and statements shares.

use naga::{Arena, Expression, Handle, Span, TypeInner};

use super::{Loc, LoweredBody, ProgramBuilder};
use crate::code::{Instruction, Operand, Slot, Word2};
use crate::error::Error;
use crate::layout::SlotKind;

impl<'b, 'm> LoweredBody<'b, 'm> {
    pub(super) fn new(
        build: &'b mut ProgramBuilder<'m>,
        expressions: &'m Arena<Expression>,
        types: Vec<&'m TypeInner>,
    ) -> Self {
        let locs = vec![None; expressions.len()];
        Self {
            build,
            expressions,
            types,
            locs,
            locals: Vec::new(),
            arguments: Vec::new(),
            function: 0,
            span: Span::UNDEFINED,
            constant: false,
            breaks: Vec::new(),
            continues: Vec::new(),
            depth: 0,
            point: None,
        }
    }

    pub(super) fn emit(&mut self, instruction: Instruction) {
        if self.constant {
            self.build.start.push(instruction);
        } else {
            self.build.program.code.push(instruction);
            self.build.program.spans.push(self.span);
        }
    }

    /// The type of an expression.
    pub(super) fn inner(&self, handle: Handle<Expression>) -> &'m TypeInner {
        self.types[handle.index()]
    }

    pub(super) fn slots(&self, handle: Handle<Expression>) -> Result<u32, Error> {
        self.build.layout.slots(self.inner(handle))
    }

    /// Kind of the scalars of an expression.
    pub(super) fn kind(&self, handle: Handle<Expression>) -> Result<SlotKind, Error> {
        let scalar = self.inner(handle).scalar();
        scalar
            .and_then(crate::layout::kind_of)
            .ok_or_else(|| Error::unsupported("an operation on this type"))
    }

    /// The operand of a value, whose components have slots of their own or share one. For a pointer
    /// it is the slot that holds the address.
    pub(super) fn operand(&mut self, handle: Handle<Expression>) -> Result<Operand, Error> {
        match self.loc(handle)? {
            Loc::Value { operand, .. } => Ok(operand),
            pointer => Ok(Operand { slot: self.address(pointer)?, stride: 1 }),
        }
    }

    /// As [`Self::operand`], for an operation on `n` components: a scalar is shared by all.
    pub(super) fn spread(&mut self, handle: Handle<Expression>, n: u32) -> Result<Operand, Error> {
        let operand = self.operand(handle)?;
        let single = n > 1 && matches!(self.inner(handle), TypeInner::Scalar(_));
        Ok(if single { Operand { stride: 0, ..operand } } else { operand })
    }

    /// The first slot of a value whose components each have a slot of their own.
    pub(super) fn dense(&mut self, handle: Handle<Expression>) -> Result<Slot, Error> {
        let (operand, n) = (self.operand(handle)?, self.slots(handle)?);
        if operand.stride == 1 || n == 1 {
            return Ok(operand.slot);
        }
        let to = self.build.alloc(n)?;
        self.emit(Instruction::Fill { to, from: operand.slot, n });
        Ok(to)
    }

    /// A slot that holds the address of a pointer.
    pub(super) fn address(&mut self, pointer: Loc) -> Result<Slot, Error> {
        match pointer {
            Loc::Value { operand, .. } => Ok(operand.slot),
            Loc::Place(place) => self.build.word(place),
            Loc::Through { slot, offset: 0 } => Ok(slot),
            Loc::Through { slot, offset } => {
                let (to, offset) = (self.build.alloc(1)?, self.build.word(offset)?);
                let [a, b] = [slot, offset].map(|slot| Operand { slot, stride: 1 });
                self.emit(Instruction::Word2 { op: Word2::Add, n: 1, to, a, b });
                Ok(to)
            }
        }
    }
}
