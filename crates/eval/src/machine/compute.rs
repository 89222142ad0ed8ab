//! Runs the instructions that only read and write memory.

use super::super::code::{Convert, Instruction, Operand, Product};
use super::super::number::Number;
use super::geometry::geometry;
use super::packing::pack;
use super::word::{extract_bits, insert_bits, word1, word2};

/// Runs one instruction. `doubt` is as for [`Number`].
#[inline(always)]
pub(super) fn compute<N: Number>(instruction: &Instruction, m: &mut [N], doubt: &mut bool) {
    match *instruction {
        Instruction::Copy { to, from, n } => copy_slots(m, to, from, n),
        Instruction::Fill { to, from, n } => {
            let value = m[from as usize];
            m[to as usize..(to + n) as usize].fill(value);
        }
        Instruction::Zero { to, n } => m[to as usize..(to + n) as usize].fill(N::default()),
        Instruction::Float1 { op, n, to, a } => {
            each_component(m, n, to, |m, i| N::unary(op, m[a.at(i)], doubt))
        }
        Instruction::Float2 { op, n, to, a, b } => {
            each_component(m, n, to, |m, i| N::binary(op, m[a.at(i)], m[b.at(i)], doubt))
        }
        Instruction::Float3 { op, n, to, a, b, c } => each_component(m, n, to, |m, i| {
            N::ternary(op, m[a.at(i)], m[b.at(i)], m[c.at(i)], doubt)
        }),
        Instruction::Compare { op, n, to, a, b } => {
            each_word(m, n, to, |m, i| u32::from(N::compare(op, m[a.at(i)], m[b.at(i)], doubt)))
        }
        Instruction::Word1 { op, n, to, a } => {
            each_word(m, n, to, |m, i| word1(op, m[a.at(i)].word()))
        }
        Instruction::Word2 { op, n, to, a, b } => {
            each_word(m, n, to, |m, i| word2(op, m[a.at(i)].word(), m[b.at(i)].word()))
        }
        Instruction::ExtractBits { signed, n, to, from, offset, count } => {
            each_word(m, n, to, |m, i| {
                extract_bits(
                    signed,
                    m[from.at(i)].word(),
                    m[offset as usize].word(),
                    m[count as usize].word(),
                )
            });
        }
        Instruction::InsertBits { n, to, from, new, offset, count } => {
            each_word(m, n, to, |m, i| {
                insert_bits(
                    [m[from.at(i)], m[new.at(i)], m[offset as usize], m[count as usize]]
                        .map(N::word),
                )
            });
        }
        Instruction::Convert { op, n, to, a } => convert(m, op, n, to, a, doubt),
        Instruction::Pack { op, to, from } => pack(m, op, to, from, doubt),
        Instruction::Select { n, to, condition, accept, reject } => {
            each_component(m, n, to, |m, i| {
                if m[condition.at(i)].word() != 0 { m[accept.at(i)] } else { m[reject.at(i)] }
            });
        }
        Instruction::Reduce { all, n, to, a } => {
            let set = m[a as usize..a as usize + usize::from(n)]
                .iter()
                .filter(|slot| slot.word() != 0)
                .count();
            m[to as usize] =
                N::from_word(u32::from(if all { set == usize::from(n) } else { set > 0 }));
        }
        Instruction::Geometry { op, n, to, a, b, c } => {
            geometry(m, op, usize::from(n), [to, a, b, c].map(|slot| slot as usize), doubt)
        }
        Instruction::Product { op, inner, rows, columns, to, a, b } => {
            matrix_product(m, op, [inner, rows, columns], to, a, b)
        }
        Instruction::Transpose { rows, columns, to, from } => {
            let (rows, columns) = (u32::from(rows), u32::from(columns));
            (0..rows * columns).for_each(|i| {
                m[(to + i) as usize] = m[(from + i % columns * rows + i / columns) as usize]
            });
        }
        Instruction::Index { to, base, index, size, count } => {
            let last = m[count as usize].word().saturating_sub(1);
            m[to as usize] = N::from_word(
                m[base as usize]
                    .word()
                    .wrapping_add(m[index as usize].word().min(last).wrapping_mul(size)),
            );
        }
        Instruction::Pick { to, from, index, size, count } => {
            copy_slots(
                m,
                to,
                from + m[index as usize].word().min(count.saturating_sub(1)) * size,
                size,
            );
        }
        Instruction::Load { to, pointer, offset, n } => {
            copy_slots(m, to, m[pointer as usize].word().wrapping_add(offset), n)
        }
        Instruction::Store { pointer, offset, from, n } => {
            copy_slots(m, m[pointer as usize].word().wrapping_add(offset), from, n)
        }
        _ => {}
    }
}

#[inline(always)]
fn copy_slots<N: Number>(m: &mut [N], to: u32, from: u32, n: u32) {
    let (to, from, n) = (to as usize, from as usize, n as usize);
    // An address outside the memory can only come from a buffer that is not bound. Nothing is
    // copied then.
    if from + n <= m.len() && to + n <= m.len() {
        m.copy_within(from..from + n, to);
    }
}

#[inline(always)]
fn each_component<N: Number>(m: &mut [N], n: u8, to: u32, mut f: impl FnMut(&[N], u32) -> N) {
    for i in 0..u32::from(n) {
        m[(to + i) as usize] = f(m, i);
    }
}

#[inline(always)]
fn each_word<N: Number>(m: &mut [N], n: u8, to: u32, mut f: impl FnMut(&[N], u32) -> u32) {
    each_component(m, n, to, |m, i| N::from_word(f(m, i)));
}

fn convert<N: Number>(m: &mut [N], op: Convert, n: u8, to: u32, a: Operand, doubt: &mut bool) {
    each_component(m, n, to, |m, i| convert_slot(op, m[a.at(i)], doubt));
}

/// Converts one slot between words and numbers.
#[inline(always)]
pub fn convert_slot<N: Number>(op: Convert, x: N, doubt: &mut bool) -> N {
    match op {
        Convert::FloatFromS => whole_number(f64::from(x.word() as i32)),
        Convert::FloatFromU => whole_number(f64::from(x.word())),
        Convert::SFromFloat => N::from_word(x.to_i32(doubt) as u32),
        Convert::UFromFloat => N::from_word(x.to_u32(doubt)),
        Convert::BoolFromFloat => N::from_word(u32::from(x.value() != 0.0)),
        Convert::FloatFromBits => N::from_f64(f64::from(f32::from_bits(x.word()))),
        Convert::BitsFromFloat => N::from_word(x.bits()),
        Convert::IsNan => N::from_word(u32::from(x.value().is_nan())),
        Convert::IsInf => N::from_word(u32::from(x.value().is_infinite())),
    }
}

/// An integer as a number. Its error is twice that of rounding to f32.
#[inline(always)]
fn whole_number<N: Number>(value: f64) -> N {
    let rounded = f64::from(value as f32);
    N::with_error(value, 2.0 * (value - rounded).abs())
}

/// Products of matrices and vectors, computed by columns of `b`.
fn matrix_product<N: Number>(
    m: &mut [N],
    op: Product,
    [inner, rows, columns]: [u8; 3],
    to: u32,
    a: u32,
    b: u32,
) {
    let (inner, rows, columns, to, a, b) = (
        usize::from(inner),
        usize::from(rows),
        usize::from(columns),
        to as usize,
        a as usize,
        b as usize,
    );
    // The distance in slots between the elements of a row of `a`. A vector on the left of a matrix
    // is a matrix of one row.
    let stride = if op == Product::VectorMatrix { 1 } else { rows };
    for column in 0..columns {
        let mut right = [N::default(); 4];
        right[..inner].copy_from_slice(&m[b + column * inner..b + (column + 1) * inner]);
        for row in 0..rows {
            let mut left = [N::default(); 4];
            (0..inner).for_each(|k| left[k] = m[a + k * stride + row]);
            m[to + column * rows + row] = N::dot(&left[..inner], &right[..inner]);
        }
    }
}
