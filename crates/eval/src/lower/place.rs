//! Lowers pointers and accesses to parts of values.

use super::{Loc, LoweredBody};
use crate::code::{Instruction, Operand, Slot};
use crate::error::Error;
use crate::program::GlobalRole;
use naga::{AddressSpace, Expression, Handle, TypeInner};

impl LoweredBody<'_, '_> {
    pub(super) fn access_index(
        &mut self,
        base: Handle<Expression>,
        index: u32,
    ) -> Result<Loc, Error> {
        let skip = self.build.layout.component(self.pointee(base), index)?;
        Ok(match self.loc(base)? {
            Loc::Value { operand, constant } => Loc::Value {
                operand: Operand { slot: operand.slot + skip * operand.stride, ..operand },
                constant,
            },
            Loc::Place(slot) => Loc::Place(slot + skip),
            Loc::Through { slot, offset } => Loc::Through { slot, offset: offset + skip },
        })
    }

    pub(super) fn access(
        &mut self,
        handle: Handle<Expression>,
        base: Handle<Expression>,
        index: Handle<Expression>,
    ) -> Result<Loc, Error> {
        let (size, count) = self.build.layout.element(self.pointee(base))?;
        let index = self.operand(index)?.slot;
        let loc = self.loc(base)?;
        if let Loc::Value { .. } = loc {
            let from = self.dense(base)?;
            let (to, _) = self.fresh(handle)?;
            self.emit(Instruction::Pick { to, from, index, size, count: count.unwrap_or(1) });
            return Ok(Loc::dense(to, false));
        }
        let count = match count {
            Some(count) => self.build.word(count)?,
            None => self.runtime_count(base)?,
        };
        let (base, to) = (self.address(loc)?, self.build.alloc(1)?);
        self.emit(Instruction::Index { to, base, index, size, count });
        Ok(Loc::Through { slot: to, offset: 0 })
    }

    pub(super) fn load(
        &mut self,
        handle: Handle<Expression>,
        pointer: Handle<Expression>,
    ) -> Result<Loc, Error> {
        let n = self.slots(handle)?;
        let loc = self.loc(pointer)?;
        // No statement can write to these address spaces, so no copy is needed.
        if let (Loc::Place(slot), Some(AddressSpace::Uniform | AddressSpace::Immediate)) =
            (loc, self.inner(pointer).pointer_space())
        {
            return Ok(Loc::dense(slot, false));
        }
        let to = self.build.alloc(n)?;
        match loc {
            Loc::Place(from) => self.emit(Instruction::Copy { to, from, n }),
            Loc::Through { slot, offset } => {
                self.emit(Instruction::Load { to, pointer: slot, offset, n })
            }
            Loc::Value { operand, .. } => {
                self.emit(Instruction::Load { to, pointer: operand.slot, offset: 0, n })
            }
        }
        Ok(Loc::dense(to, false))
    }

    pub(super) fn store(
        &mut self,
        pointer: Handle<Expression>,
        value: Handle<Expression>,
    ) -> Result<(), Error> {
        let (operand, n) = (self.operand(value)?, self.slots(value)?);
        match self.loc(pointer)? {
            Loc::Place(to) if operand.stride == 0 => {
                self.emit(Instruction::Fill { to, from: operand.slot, n })
            }
            Loc::Place(to) => self.emit(Instruction::Copy { to, from: operand.slot, n }),
            Loc::Through { slot, offset } => {
                let from = self.dense(value)?;
                self.emit(Instruction::Store { pointer: slot, offset, from, n });
            }
            Loc::Value { operand, .. } => {
                let from = self.dense(value)?;
                self.emit(Instruction::Store { pointer: operand.slot, offset: 0, from, n });
            }
        }
        Ok(())
    }

    pub(super) fn array_length(&mut self, pointer: Handle<Expression>) -> Result<Loc, Error> {
        Ok(Loc::dense(self.runtime_count(pointer)?, false))
    }

    /// The slot with the length of a buffer's runtime-sized array.
    fn runtime_count(&mut self, pointer: Handle<Expression>) -> Result<Slot, Error> {
        let variable = match self.expressions[pointer] {
            Expression::GlobalVariable(variable) => variable,
            Expression::AccessIndex { base, .. } => match self.expressions[base] {
                Expression::GlobalVariable(variable) => variable,
                _ => return Err(Error::unsupported("the length of this array")),
            },
            _ => return Err(Error::unsupported("the length of an array behind a parameter")),
        };
        let name = self.build.module.global_variables[variable].binding;
        let binding = name.map(|binding| (binding.group, binding.binding));
        match self
            .build
            .program
            .globals
            .iter()
            .find(|global| global.binding == binding)
            .map(|global| global.role)
        {
            Some(GlobalRole::Runtime { count, .. }) => Ok(count),
            _ => Err(Error::unsupported("the length of this array")),
        }
    }

    /// The type that a pointer points to, or the type of a value.
    fn pointee(&self, handle: Handle<Expression>) -> &TypeInner {
        match *self.inner(handle) {
            TypeInner::Pointer { base, .. } => &self.build.module.types[base].inner,
            ref inner => inner,
        }
    }
}
