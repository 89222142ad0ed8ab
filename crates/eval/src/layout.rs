//! The layout of naga's types in slots, and in the bytes of buffers.

use crate::error::Error;
use naga::{ArraySize, Binding, Handle, Scalar, ScalarKind, Type, TypeInner, UniqueArena};

/// The most slots of a program. The four lanes of a quad then take 64 MiB of `f64`.
pub const MAX_SLOTS: u32 = lamplight_files::limits::EVAL_SLOTS;

/// What one slot of an argument or result holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SlotKind {
    /// A floating-point number.
    Float,
    /// A signed integer.
    Sint,
    /// An unsigned integer.
    Uint,
    /// True or false.
    Bool,
    /// Address of a slot.
    Pointer,
    /// Index of a texture or sampler in the resources.
    Handle,
}

/// The kind of a scalar. `None` if the evaluator does not support the scalar.
pub fn kind_of(scalar: Scalar) -> Option<SlotKind> {
    match (scalar.kind, scalar.width) {
        (ScalarKind::Bool, _) => Some(SlotKind::Bool),
        (ScalarKind::Sint, 4) => Some(SlotKind::Sint),
        (ScalarKind::Uint, 4) => Some(SlotKind::Uint),
        (ScalarKind::Float, 4) | (ScalarKind::AbstractFloat, _) => Some(SlotKind::Float),
        (ScalarKind::AbstractInt, _) => Some(SlotKind::Sint),
        _ => None,
    }
}

/// How many slots each type of a module takes, by its handle. `None` if the evaluator does not
/// support the type.
#[derive(Debug)]
pub struct Layout<'m> {
    pub types: &'m UniqueArena<Type>,
    sizes: Vec<Option<u32>>,
}

impl<'m> Layout<'m> {
    /// Measures every type. A runtime-sized array counts as one element.
    pub fn new(types: &'m UniqueArena<Type>) -> Self {
        let mut layout = Self { types, sizes: Vec::with_capacity(types.len()) };
        for (_, ty) in types.iter() {
            let size = layout.measure(&ty.inner);
            layout.sizes.push(size);
        }
        layout
    }

    /// Slots of a type of the module.
    pub fn size(&self, ty: Handle<Type>) -> Result<u32, Error> {
        self.sizes
            .get(ty.index())
            .copied()
            .flatten()
            .ok_or_else(|| self.unsupported(&self.types[ty].inner))
    }

    /// Slots of a value of this type.
    pub fn slots(&self, inner: &TypeInner) -> Result<u32, Error> {
        self.measure(inner).ok_or_else(|| self.unsupported(inner))
    }

    /// Appends the kind of each slot of a type, in order.
    pub fn kinds(&self, ty: Handle<Type>, to: &mut Vec<SlotKind>) -> Result<(), Error> {
        let slots = self.size(ty)?;
        if slots > MAX_SLOTS {
            return Err(Error::too_large("a type takes too many scalars"));
        }
        match self.types[ty].inner {
            TypeInner::Array { base, .. } => {
                let mut element = Vec::new();
                self.kinds(base, &mut element)?;
                let times = slots as usize / element.len().max(1);
                to.extend(element.iter().copied().cycle().take(element.len() * times));
            }
            TypeInner::Struct { ref members, .. } => {
                members.iter().try_for_each(|member| self.kinds(member.ty, to))?
            }
            ref inner => to.extend(std::iter::repeat_n(leaf_kind(inner), slots as usize)),
        }
        Ok(())
    }

    /// Appends the binding of each slot of an entry point's argument or result.
    pub fn bindings(
        &self,
        ty: Handle<Type>,
        own: &Option<Binding>,
        to: &mut Vec<Option<Binding>>,
    ) -> Result<(), Error> {
        match (own, &self.types[ty].inner) {
            (None, TypeInner::Struct { members, .. }) => {
                members.iter().try_for_each(|member| self.bindings(member.ty, &member.binding, to))
            }
            _ => {
                to.extend(std::iter::repeat_n(own.clone(), self.size(ty)? as usize));
                Ok(())
            }
        }
    }

    /// The offset of a component, in slots. A component is a member, an element, a column or a
    /// scalar.
    pub fn component(&self, inner: &TypeInner, index: u32) -> Result<u32, Error> {
        match *inner {
            TypeInner::Struct { ref members, .. } => {
                members.iter().take(index as usize).map(|member| self.size(member.ty)).sum()
            }
            _ => Ok(index.saturating_mul(self.element(inner)?.0)),
        }
    }

    /// The slots of one element, and the number of elements; `None` if that is known only when the
    /// program runs.
    pub fn element(&self, inner: &TypeInner) -> Result<(u32, Option<u32>), Error> {
        match *inner {
            TypeInner::Vector { size, .. } => Ok((1, Some(size as u32))),
            TypeInner::ValuePointer { size: Some(size), .. } => Ok((1, Some(size as u32))),
            TypeInner::Matrix { columns, rows, .. } => Ok((rows as u32, Some(columns as u32))),
            TypeInner::Array { base, size: ArraySize::Constant(count), .. } => {
                Ok((self.size(base)?, Some(count.get())))
            }
            TypeInner::Array { base, size: ArraySize::Dynamic, .. } => Ok((self.size(base)?, None)),
            TypeInner::Pointer { base, .. } => self.element(&self.types[base].inner),
            _ => Err(self.unsupported(inner)),
        }
    }

    fn measure(&self, inner: &TypeInner) -> Option<u32> {
        let limit = |slots: u64| u32::try_from(slots.min(u64::from(MAX_SLOTS) + 1)).ok();
        match *inner {
            TypeInner::Scalar(scalar) | TypeInner::Atomic(scalar) => kind_of(scalar).map(|_| 1),
            TypeInner::Vector { size, scalar } => kind_of(scalar).map(|_| size as u32),
            TypeInner::Matrix { columns, rows, scalar } => {
                kind_of(scalar).map(|_| columns as u32 * rows as u32)
            }
            TypeInner::Array { base, size: ArraySize::Constant(count), .. } => {
                limit(u64::from(self.size(base).ok()?) * u64::from(count.get()))
            }
            TypeInner::Array { base, size: ArraySize::Dynamic, .. } => self.size(base).ok(),
            TypeInner::Struct { ref members, .. } => {
                let sizes: Option<Vec<u64>> =
                    members.iter().map(|member| self.size(member.ty).ok().map(u64::from)).collect();
                limit(sizes?.iter().sum())
            }
            TypeInner::Pointer { .. }
            | TypeInner::ValuePointer { .. }
            | TypeInner::Image { .. }
            | TypeInner::Sampler { .. } => Some(1),
            _ => None,
        }
    }

    fn unsupported(&self, inner: &TypeInner) -> Error {
        Error::unsupported(format!("values of the type {}", type_name(inner)))
    }
}

/// Reads a buffer's bytes into slots: calls `write` with the kind and the four bytes of each
/// scalar. Bytes that are missing read as zero.
pub fn decode_buffer(
    types: &UniqueArena<Type>,
    ty: Handle<Type>,
    bytes: &[u8],
    write: &mut dyn FnMut(SlotKind, u32),
) {
    each_scalar(types, ty, (0, bytes.len()), &mut |kind, at| {
        let word = bytes.get(at..at + 4).and_then(|bytes| bytes.try_into().ok());
        write(kind, word.map_or(0, u32::from_le_bytes));
    });
}

/// Writes slots into a buffer's bytes: `read` gives the four bytes of each scalar. Bytes between
/// scalars stay as they are.
pub fn encode_buffer(
    types: &UniqueArena<Type>,
    ty: Handle<Type>,
    bytes: &mut [u8],
    read: &mut dyn FnMut(SlotKind) -> u32,
) {
    each_scalar(types, ty, (0, bytes.len()), &mut |kind, at| {
        let word = read(kind).to_le_bytes();
        if let Some(bytes) = bytes.get_mut(at..at + 4) {
            bytes.copy_from_slice(&word);
        }
    });
}

/// Calls a function with the kind and the offset of each scalar of a type in a buffer. The type
/// begins at the first of the two offsets, and the buffer ends at the second.
fn each_scalar(
    types: &UniqueArena<Type>,
    ty: Handle<Type>,
    (from, end): (usize, usize),
    see: &mut dyn FnMut(SlotKind, usize),
) {
    let mut scalars = |scalar: Scalar, count: u32, from: usize| {
        let kind = kind_of(scalar).unwrap_or(SlotKind::Uint);
        (0..count as usize).for_each(|index| see(kind, from.saturating_add(4 * index)));
    };
    match types[ty].inner {
        TypeInner::Scalar(scalar) | TypeInner::Atomic(scalar) => scalars(scalar, 1, from),
        TypeInner::Vector { size, scalar } => scalars(scalar, size as u32, from),
        TypeInner::Matrix { columns, rows, scalar } => {
            let stride = if rows as u32 == 2 { 8 } else { 16 };
            let column = |column: usize| from.saturating_add(column * stride);
            (0..columns as usize).for_each(|index| scalars(scalar, rows as u32, column(index)));
        }
        TypeInner::Array { base, size, stride } => {
            let stride = stride as usize;
            let count = if let ArraySize::Constant(count) = size {
                count.get() as usize
            } else {
                end.saturating_sub(from) / stride.max(1)
            };
            (0..count).for_each(|index| {
                let first = from.saturating_add(index.saturating_mul(stride));
                each_scalar(types, base, (first, end), see)
            });
        }
        TypeInner::Struct { ref members, .. } => {
            members.iter().for_each(|member| {
                let first = from.saturating_add(member.offset as usize);
                each_scalar(types, member.ty, (first, end), see)
            });
        }
        _ => {}
    }
}

fn leaf_kind(inner: &TypeInner) -> SlotKind {
    match *inner {
        TypeInner::Pointer { .. } | TypeInner::ValuePointer { .. } => SlotKind::Pointer,
        TypeInner::Image { .. } | TypeInner::Sampler { .. } => SlotKind::Handle,
        _ => inner.scalar().and_then(kind_of).unwrap_or(SlotKind::Uint),
    }
}

fn type_name(inner: &TypeInner) -> String {
    match inner.scalar() {
        Some(scalar) => format!("`{:?}{}`", scalar.kind, u32::from(scalar.width) * 8),
        None => {
            let text = format!("{inner:?}");
            format!("`{}`", text.split([' ', '(', '{']).next().unwrap_or("?"))
        }
    }
}
