//! What the text calls the values of a program, and where they are.

use crate::number::Number;
use crate::program::FunctionId;
use crate::shape::Shape;
use naga::Span;

/// A value that has a name in the text.
#[derive(Debug, Clone)]
pub struct Variable {
    /// The function that it is in; `None` for one of the module.
    pub function: Option<FunctionId>,
    /// As in the text that naga parsed.
    pub name: String,
    /// What it is.
    pub kind: VariableKind,
    /// How it is made of scalars.
    pub shape: Shape,
    /// Where its scalars are.
    pub place: VariablePlace,
    /// Its declaration, or the expression that it names.
    pub span: Span,
}

/// What has a name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum VariableKind {
    /// A parameter of a function.
    Parameter,
    /// A value that a `let` names.
    Let,
    /// A variable of a function.
    Var,
    /// A variable of the module that each invocation has.
    Private,
    /// A variable of the module that a buffer is bound to.
    Buffer,
    /// What a function returns.
    Result,
}

/// Where a value is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum VariablePlace {
    /// In slots, `stride` apart: 0 if all components share one.
    At { slot: u32, stride: u32 },
    /// Where the address in a slot, plus an offset, points to.
    Through { slot: u32, offset: u32 },
}

impl VariablePlace {
    /// The slot of scalar `index`.
    pub fn slot<N: Number>(self, index: u32, memory: &[N]) -> u32 {
        match self {
            Self::At { slot, stride } => slot + index * stride,
            Self::Through { slot, offset } => {
                let address = memory.get(slot as usize).map_or(0, |slot| slot.word());
                address.wrapping_add(offset).wrapping_add(index)
            }
        }
    }
}
