//! What the text calls the values of a program, and where they are.

use crate::layout::{SlotKind, kind_of};
use crate::number::Number;
use crate::program::FunctionId;
use naga::{ArraySize, Handle, Span, Type, TypeInner, UniqueArena};

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

/// How a value is made of scalars.
#[derive(Debug, Clone, PartialEq)]
pub enum Shape {
    /// One scalar.
    Scalar(SlotKind),
    /// Two to four scalars.
    Vector(u32, SlotKind),
    /// Columns of rows.
    Matrix { columns: u32, rows: u32 },
    /// Elements of one shape.
    Array(u32, Box<Self>),
    /// Members by name.
    Struct(Vec<(String, Self)>),
}

impl Shape {
    /// The shape of a type; `None` for pointers, textures and samplers. A runtime-sized array has
    /// one element.
    pub fn of(types: &UniqueArena<Type>, inner: &TypeInner) -> Option<Self> {
        let typed = |ty: Handle<Type>| Self::of(types, &types[ty].inner);
        Some(match *inner {
            TypeInner::Scalar(scalar) | TypeInner::Atomic(scalar) => Self::Scalar(kind_of(scalar)?),
            TypeInner::Vector { size, scalar } => Self::Vector(size as u32, kind_of(scalar)?),
            TypeInner::Matrix { columns, rows, scalar: _ } => {
                Self::Matrix { columns: columns as u32, rows: rows as u32 }
            }
            TypeInner::Array { base, size, stride: _ } => {
                let count = if let ArraySize::Constant(count) = size { count.get() } else { 1 };
                Self::Array(count, Box::new(typed(base)?))
            }
            TypeInner::Struct { ref members, span: _ } => {
                let member = |(index, member): (usize, &naga::StructMember)| {
                    let name = member.name.clone().unwrap_or_else(|| index.to_string());
                    Some((name, typed(member.ty)?))
                };
                Self::Struct(members.iter().enumerate().map(member).collect::<Option<_>>()?)
            }
            _ => return None,
        })
    }

    /// How many scalars it has.
    pub fn scalars(&self) -> u32 {
        match self {
            Self::Scalar(_) => 1,
            Self::Vector(count, _) => *count,
            Self::Matrix { columns, rows } => columns * rows,
            Self::Array(count, element) => count.saturating_mul(element.scalars()),
            Self::Struct(members) => members.iter().map(|(_, shape)| shape.scalars()).sum(),
        }
    }
}
