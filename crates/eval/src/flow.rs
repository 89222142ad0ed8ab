//! Which slots an instruction reads and writes.

use crate::code::{Access, Geometry, Instruction, Lod, Operand, Packing, Product, Slot, TextureOp};
use crate::number::Number;
use crate::program::Program;
use std::ops::Range;

/// Slots that lie together.
pub type SlotRange = Range<u32>;

fn range(from: Slot, n: impl Into<u32>) -> SlotRange {
    from..from.saturating_add(n.into())
}

fn spread(operand: Operand, n: u8) -> SlotRange {
    range(operand.slot, if operand.stride == 0 { 1 } else { u32::from(n) })
}

/// The slots that an instruction writes. `m` is the memory before or after it.
pub fn written<N: Number>(program: &Program, instruction: &Instruction, m: &[N]) -> SlotRange {
    let address = |pointer: Slot, offset: u32| {
        m.get(pointer as usize).map_or(0, |slot| slot.word().wrapping_add(offset))
    };
    match *instruction {
        Instruction::Copy { to, n, from: _ }
        | Instruction::Fill { to, n, from: _ }
        | Instruction::Zero { to, n }
        | Instruction::Load { to, n, pointer: _, offset: _ }
        | Instruction::Pick { to, size: n, from: _, index: _, count: _ } => range(to, n),
        Instruction::Float1 { to, n, .. }
        | Instruction::Float2 { to, n, .. }
        | Instruction::Float3 { to, n, .. }
        | Instruction::Compare { to, n, .. }
        | Instruction::Word1 { to, n, .. }
        | Instruction::Word2 { to, n, .. }
        | Instruction::ExtractBits { to, n, .. }
        | Instruction::InsertBits { to, n, .. }
        | Instruction::Convert { to, n, .. }
        | Instruction::Select { to, n, .. }
        | Instruction::Derivative { to, n, .. } => range(to, n),
        Instruction::Reduce { to, .. } | Instruction::Index { to, .. } => range(to, 1u32),
        Instruction::Pack { op, to, .. } => range(to, packed_parts(op).1),
        Instruction::Geometry { op, n, to, .. } => range(to, geometry_slots(op, u32::from(n)).0),
        Instruction::Product { rows, columns, to, .. }
        | Instruction::Transpose { rows, columns, to, .. } => {
            range(to, u32::from(rows) * u32::from(columns))
        }
        Instruction::Store { pointer, offset, n, .. } => range(address(pointer, offset), n),
        Instruction::Image { access } => {
            program.access(access).map_or(0..0, |access| range(access.to, access.n))
        }
        Instruction::Jump { .. }
        | Instruction::JumpUnless { .. }
        | Instruction::Switch { .. }
        | Instruction::Call { .. }
        | Instruction::Return
        | Instruction::Trip
        | Instruction::Mark { .. }
        | Instruction::Kill
        | Instruction::Barrier => 0..0,
    }
}

/// Calls `see` with the slots that an instruction reads.
pub fn read<N: Number>(
    program: &Program,
    instruction: &Instruction,
    m: &[N],
    see: &mut dyn FnMut(SlotRange),
) {
    match *instruction {
        Instruction::Copy { from, n, .. } => see(range(from, n)),
        Instruction::Fill { from, .. } => see(range(from, 1u32)),
        Instruction::Float1 { n, a, .. }
        | Instruction::Word1 { n, a, .. }
        | Instruction::Convert { n, a, .. }
        | Instruction::Derivative { n, a, .. } => see(spread(a, n)),
        Instruction::Float2 { n, a, b, .. }
        | Instruction::Compare { n, a, b, .. }
        | Instruction::Word2 { n, a, b, .. } => [a, b].into_iter().for_each(|a| see(spread(a, n))),
        Instruction::Float3 { n, a, b, c, .. } => {
            [a, b, c].into_iter().for_each(|a| see(spread(a, n)))
        }
        _ => read_parts(program, instruction, m, see),
    }
}

/// The same, for instructions that read more than numbers in order.
fn read_parts<N: Number>(
    program: &Program,
    instruction: &Instruction,
    m: &[N],
    see: &mut dyn FnMut(SlotRange),
) {
    match *instruction {
        Instruction::ExtractBits { n, from, offset, count, .. } => {
            see(spread(from, n));
            [offset, count].into_iter().for_each(|slot| see(range(slot, 1u32)));
        }
        Instruction::InsertBits { n, from, new, offset, count, .. } => {
            [from, new].into_iter().for_each(|a| see(spread(a, n)));
            [offset, count].into_iter().for_each(|slot| see(range(slot, 1u32)));
        }
        Instruction::Pack { op, from, .. } => see(range(from, packed_parts(op).0)),
        Instruction::Select { n, condition, accept, reject, .. } => {
            see(spread(condition, n));
            for i in 0..u32::from(n) {
                let holds = m[condition.at(i)].word() != 0;
                see(range(if holds { accept } else { reject }.at(i) as u32, 1u32));
            }
        }
        Instruction::Reduce { n, a, .. } => see(range(a, n)),
        Instruction::Geometry { op, n, a, b, c, .. } => {
            let counts = geometry_slots(op, u32::from(n)).1;
            [a, b, c].into_iter().zip(counts).for_each(|(slot, n)| see(range(slot, n)));
        }
        Instruction::Product { op, inner, rows, columns, a, b, .. } => {
            let [inner, rows, columns] = [inner, rows, columns].map(u32::from);
            let outer = op == Product::Outer;
            see(range(a, if outer { rows } else { inner * rows }));
            see(range(b, if outer { columns } else { inner * columns }));
        }
        _ => read_memory(program, instruction, m, see),
    }
}

/// The same, for instructions that read where other values say, and for those that read nothing.
fn read_memory<N: Number>(
    program: &Program,
    instruction: &Instruction,
    m: &[N],
    see: &mut dyn FnMut(SlotRange),
) {
    match *instruction {
        Instruction::Transpose { rows, columns, from, .. } => {
            see(range(from, u32::from(rows) * u32::from(columns)))
        }
        Instruction::Index { base, index, .. } => {
            [base, index].into_iter().for_each(|slot| see(range(slot, 1u32)))
        }
        Instruction::Pick { from, index, size, count, .. } => {
            see(range(index, 1u32));
            let at = m[index as usize].word().min(count.saturating_sub(1));
            see(range(from + at * size, size));
        }
        Instruction::Load { pointer, offset, n, .. } => {
            see(range(pointer, 1u32));
            see(range(m[pointer as usize].word().wrapping_add(offset), n));
        }
        Instruction::Store { pointer, from, n, .. } => {
            see(range(pointer, 1u32));
            see(range(from, n));
        }
        Instruction::JumpUnless { condition: slot, .. }
        | Instruction::Switch { selector: slot, .. } => see(range(slot, 1u32)),
        Instruction::Image { access } => {
            program.access(access).into_iter().for_each(|access| read_texture(access, see))
        }
        _ => {}
    }
}

fn read_texture(access: &Access, see: &mut dyn FnMut(SlotRange)) {
    see(range(access.coordinate, access.dimensions));
    access.layer.into_iter().for_each(|slot| see(range(slot, 1u32)));
    match access.ask {
        TextureOp::Sample { level, reference, .. } => {
            match level {
                Lod::Exact(slot) | Lod::Bias(slot) => see(range(slot, 1u32)),
                Lod::Gradient(x, y) => {
                    [x, y].into_iter().for_each(|slot| see(range(slot, access.dimensions)))
                }
                Lod::Auto | Lod::Zero => {}
            }
            reference.into_iter().for_each(|slot| see(range(slot, 1u32)));
        }
        TextureOp::Load { level } | TextureOp::Size { level } => {
            level.into_iter().for_each(|slot| see(range(slot, 1u32)))
        }
        TextureOp::Levels | TextureOp::Layers | TextureOp::Samples => {}
    }
}

/// How many slots a packing function reads and writes.
fn packed_parts(op: Packing) -> (u32, u32) {
    match op {
        Packing::Pack4Snorm8
        | Packing::Pack4Unorm8
        | Packing::Pack4
        | Packing::PackClampS
        | Packing::PackClampU => (4, 1),
        Packing::Pack2Snorm16 | Packing::Pack2Unorm16 | Packing::Pack2Half => (2, 1),
        Packing::Unpack4Snorm8 | Packing::Unpack4Unorm8 | Packing::Unpack4S | Packing::Unpack4U => {
            (1, 4)
        }
        Packing::Unpack2Snorm16 | Packing::Unpack2Unorm16 | Packing::Unpack2Half => (1, 2),
    }
}

/// How many slots a function of whole vectors writes, and reads of each operand.
fn geometry_slots(op: Geometry, n: u32) -> (u32, [u32; 3]) {
    match op {
        Geometry::Dot | Geometry::DotWord | Geometry::Distance => (1, [n, n, 0]),
        Geometry::Cross => (3, [3, 3, 0]),
        Geometry::Length => (1, [n, 0, 0]),
        Geometry::Normalize => (n, [n, 0, 0]),
        Geometry::FaceForward => (n, [n, n, n]),
        Geometry::Reflect => (n, [n, n, 0]),
        Geometry::Refract => (n, [n, n, 1]),
        Geometry::Determinant => (1, [n * n, 0, 0]),
        Geometry::Inverse => (n * n, [n * n, 0, 0]),
        Geometry::Modf | Geometry::Frexp => (2 * n, [n, 0, 0]),
        Geometry::Ldexp => (n, [n, n, 0]),
    }
}
