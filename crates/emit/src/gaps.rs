//! Members that lie elsewhere than their types alone say: behind `@size`, at an `@align`, or at an
//! `offset` of GLSL. naga's writers of WGSL and GLSL write types alone, so a shader would read other
//! bytes than its host has written.

use std::collections::BTreeSet;

use naga::proc::Alignment;
use naga::{ArraySize, Handle, Module, Scalar, StructMember, Type, TypeInner, VectorSize};

/// How a language lays out types.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Rules {
    /// WGSL, and storage buffers of GLSL: `std430`.
    Plain,
    /// Uniform blocks of GLSL, where arrays and structures have the alignment of `vec4` at least.
    Std140,
}

/// Bytes before a member, or behind the last one, that nothing in the types accounts for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Gap {
    /// The index of the member; the number of members for the end.
    pub before: usize,
    pub from: u32,
    pub to: u32,
}

/// What a type takes in a structure.
struct Room {
    alignment: Alignment,
    size: u32,
}

/// The structures that a type is or has.
pub fn collect_structs(module: &Module, ty: Handle<Type>, found: &mut BTreeSet<Handle<Type>>) {
    match &module.types[ty].inner {
        TypeInner::Array { base, size: _, stride: _ }
        | TypeInner::BindingArray { base, size: _ } => {
            collect_structs(module, *base, found);
        }
        TypeInner::Struct { members, span: _ } if found.insert(ty) => {
            members.iter().for_each(|member| collect_structs(module, member.ty, found));
        }
        _ => {}
    }
}

/// The gaps of a structure.
///
/// # Errors
/// A member lies before where its type may, which the language cannot express.
pub fn gaps_of(module: &Module, ty: Handle<Type>, rules: Rules) -> Result<Vec<Gap>, String> {
    let TypeInner::Struct { members, span } = &module.types[ty].inner else {
        return Ok(Vec::new());
    };
    let (mut gaps, mut end) = (Vec::new(), 0);
    for (before, member) in members.iter().enumerate() {
        let StructMember { name, ty, binding: _, offset } = member;
        let room = room_of(module, *ty, rules);
        let natural = room.alignment.round_up(end);
        if natural > *offset {
            let name = name.as_deref().unwrap_or("a member");
            return Err(format!("`{name}` lies at {offset}, where its type cannot lie"));
        }
        if natural < *offset {
            gaps.push(Gap { before, from: end, to: *offset });
        }
        end = offset + room.size;
    }
    if alignment_of(module, ty, rules).round_up(end) < *span && !is_endless_struct(module, ty) {
        gaps.push(Gap { before: members.len(), from: end, to: *span });
    }
    Ok(gaps)
}

/// Where each member of a structure ends.
pub fn ends_of(module: &Module, ty: Handle<Type>, rules: Rules) -> Vec<u32> {
    match &module.types[ty].inner {
        TypeInner::Struct { members, span: _ } => {
            let end =
                |member: &StructMember| member.offset + room_of(module, member.ty, rules).size;
            members.iter().map(end).collect()
        }
        _ => Vec::new(),
    }
}

/// Whether a structure ends with an array without a length.
pub fn is_endless_struct(module: &Module, ty: Handle<Type>) -> bool {
    let TypeInner::Struct { members, span: _ } = &module.types[ty].inner else { return false };
    members.last().is_some_and(|last| {
        matches!(
            module.types[last.ty].inner,
            TypeInner::Array { size: ArraySize::Dynamic, base: _, stride: _ }
        )
    })
}

/// The alignment that a type has by itself.
pub fn alignment_of(module: &Module, ty: Handle<Type>, rules: Rules) -> Alignment {
    room_of(module, ty, rules).alignment
}

fn room_of(module: &Module, ty: Handle<Type>, rules: Rules) -> Room {
    let at_least = |alignment: Alignment| match rules {
        Rules::Plain => alignment,
        Rules::Std140 => alignment.max(Alignment::SIXTEEN),
    };
    match &module.types[ty].inner {
        TypeInner::Scalar(Scalar { kind: _, width })
        | TypeInner::Atomic(Scalar { kind: _, width }) => {
            Room { alignment: Alignment::from_width(*width), size: u32::from(*width) }
        }
        TypeInner::Vector { size, scalar } => vector_room(*size, *scalar),
        TypeInner::Matrix { columns, rows, scalar } => {
            let Room { alignment, size } = vector_room(*rows, *scalar);
            let alignment = at_least(alignment);
            Room { alignment, size: alignment.round_up(size) * *columns as u32 }
        }
        TypeInner::Array { base, size, stride } => {
            let count = match size {
                ArraySize::Constant(count) => count.get(),
                ArraySize::Pending(_) | ArraySize::Dynamic => 1,
            };
            let alignment = at_least(room_of(module, *base, rules).alignment);
            Room { alignment, size: stride.saturating_mul(count) }
        }
        TypeInner::Struct { members, span } => {
            let all = members.iter().map(|member| room_of(module, member.ty, rules).alignment);
            let alignment = at_least(all.max().unwrap_or(Alignment::ONE));
            Room { alignment, size: alignment.round_up(*span) }
        }
        // Nothing else lies in a buffer.
        _ => Room { alignment: Alignment::ONE, size: 0 },
    }
}

fn vector_room(size: VectorSize, scalar: Scalar) -> Room {
    let alignment = Alignment::from(size) * Alignment::from_width(scalar.width);
    Room { alignment, size: size as u32 * u32::from(scalar.width) }
}
