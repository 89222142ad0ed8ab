//! Runs the instructions that only read and write memory, for all lanes at once. Each lane gets
//! the bits that [`crate::Machine`] would give it: the operations are the same functions.

use super::super::code::{Binary, Compare, Convert, Instruction, Operand, Ternary, Unary};
use super::super::code::{Word1, Word2};
use super::super::machine::{convert_slot, extract_bits, insert_bits, pack, word1, word2};
use super::super::number::Number;
use super::geometry::{geometry, matrix_product};
use super::rows::{LANES, LaneRows, Row, each_lane, lanes_of};

/// Runs one instruction.
#[inline(always)]
pub fn compute(instruction: &Instruction, rows: &mut LaneRows<'_>) {
    match *instruction {
        Instruction::Copy { to, from, n } => rows.copy(to, from, n),
        Instruction::Fill { to, from, n } => {
            let row = rows.row(from);
            (0..n).for_each(|i| rows.put(to + i, row));
        }
        Instruction::Zero { to, n } => (0..n).for_each(|i| rows.put(to + i, [0.0; LANES])),
        Instruction::Float1 { op, n, to, a } => unary(rows, op, n, to, a),
        Instruction::Float2 { op, n, to, a, b } => binary(rows, op, n, to, [a, b]),
        Instruction::Float3 { op, n, to, a, b, c } => ternary(rows, op, n, to, [a, b, c]),
        Instruction::Compare { op, n, to, a, b } => compare(rows, op, n, to, [a, b]),
        Instruction::Word1 { op, n, to, a } => word_unary(rows, op, n, to, a),
        Instruction::Word2 { op, n, to, a, b } => word_binary(rows, op, n, to, [a, b]),
        Instruction::Select { n, to, condition, accept, reject } => {
            each3(rows, n, to, [condition, accept, reject], |condition, accept, reject| {
                if condition.to_bits() != 0 { accept } else { reject }
            });
        }
        Instruction::Index { to, base, index, size, count } => {
            let (base, index, count) = (rows.words(base), rows.words(index), rows.words(count));
            let at = |i: usize| {
                let last = count[i].saturating_sub(1);
                base[i].wrapping_add(index[i].min(last).wrapping_mul(size))
            };
            rows.put_words(to, each_lane(at));
        }
        Instruction::Load { to, pointer, offset, n } => {
            moved(rows, pointer, |rows, address| rows.copy(to, address.wrapping_add(offset), n), {
                |view, address| view.copy(to, address.wrapping_add(offset), n)
            })
        }
        Instruction::Store { pointer, offset, from, n } => moved(
            rows,
            pointer,
            |rows, address| rows.copy(address.wrapping_add(offset), from, n),
            |view, address| view.copy(address.wrapping_add(offset), from, n),
        ),
        Instruction::Pick { to, from, index, size, count } => {
            let place = |index: u32| from + index.min(count.saturating_sub(1)) * size;
            moved(rows, index, |rows, index| rows.copy(to, place(index), size), {
                |view, index| view.copy(to, place(index), size)
            })
        }
        _ => seldom(instruction, rows),
    }
}

/// If the slot has the same word in all active lanes, calls `all` once with that word. Otherwise
/// calls `one` for each active lane with the lane's own word.
#[inline(always)]
fn moved(
    rows: &mut LaneRows<'_>,
    slot: u32,
    all: impl FnOnce(&mut LaneRows<'_>, u32),
    one: impl Fn(&mut super::rows::LaneView<'_>, u32),
) {
    if let Some(word) = rows.common(slot) {
        return all(rows, word);
    }
    let words = rows.words(slot);
    for lane in lanes_of(rows.mask) {
        one(&mut rows.lane(lane), words[lane]);
    }
}

/// Instructions that few programs run often.
fn seldom(instruction: &Instruction, rows: &mut LaneRows<'_>) {
    match *instruction {
        Instruction::ExtractBits { signed, n, to, from, offset, count } => {
            let (offset, count) = (rows.words(offset), rows.words(count));
            each_row(rows, n, to, from, |i, x| extract_bits(signed, x, offset[i], count[i]));
        }
        Instruction::InsertBits { n, to, from, new, offset, count } => {
            let (offset, count) = (rows.words(offset), rows.words(count));
            for part in 0..u32::from(n) {
                let (old, new) =
                    (rows.words(from.at(part) as u32), rows.words(new.at(part) as u32));
                let word = |i: usize| insert_bits([old[i], new[i], offset[i], count[i]]);
                rows.put_words(to + part, each_lane(word));
            }
        }
        Instruction::Convert { op, n, to, a } => convert(rows, op, n, to, a),
        Instruction::Pack { op, to, from } => {
            // No packing function has more than four slots on either side. The slots of the result
            // that it does not write keep their values.
            on_each_lane(rows, &[(from, 4)], (to, 4), |m| pack(m, op, 4, 0, &mut false));
        }
        Instruction::Reduce { all, n, to, a } => {
            let set = (a..a + u32::from(n)).map(|slot| rows.words(slot).map(|word| word != 0));
            let found = set.fold([all; LANES], |found, set| {
                std::array::from_fn(|i| if all { found[i] & set[i] } else { found[i] | set[i] })
            });
            rows.put_words(to, found.map(u32::from));
        }
        Instruction::Geometry { op, n, to, a, b, c } => {
            geometry(rows, op, u32::from(n), [to, a, b, c])
        }
        Instruction::Product { op, inner, rows: height, columns, to, a, b } => {
            let sizes = [inner, height, columns].map(u32::from);
            matrix_product(rows, op, sizes, [to, a, b])
        }
        Instruction::Transpose { rows: height, columns, to, from } => {
            let (height, columns) = (u32::from(height), u32::from(columns));
            for i in 0..height * columns {
                rows.put(to + i, rows.row(from + i % columns * height + i / columns));
            }
        }
        _ => {}
    }
}

/// Calls a function once for each active lane. The function gets a copy of the lane's slots in one
/// slice: the operands in order, then the result. Afterwards the result is copied back.
pub fn on_each_lane(
    rows: &mut LaneRows<'_>,
    operands: &[(u32, u32)],
    (to, n): (u32, u32),
    run: impl Fn(&mut [f32]),
) {
    // The most is a 4x4 inverse, with one matrix as the operand and one as the result.
    let mut m = [0.0; 32];
    let slots = || operands.iter().flat_map(|(slot, n)| *slot..slot + n).chain(to..to + n);
    let result: usize = operands.iter().map(|(_, n)| *n as usize).sum();
    for lane in lanes_of(rows.mask) {
        // `operands` may name slots beyond the memory's end. No function uses these.
        for (value, slot) in m.iter_mut().zip(slots()) {
            *value = rows.m.get(slot as usize).map_or(0.0, |row| row[lane]);
        }
        run(&mut m);
        for (value, slot) in m[result..].iter().zip(to..to + n) {
            if let Some(row) = rows.m.get_mut(slot as usize) {
                row[lane] = *value;
            }
        }
    }
}

#[inline(always)]
fn each1(rows: &mut LaneRows<'_>, n: u8, to: u32, a: Operand, f: impl Fn(f32) -> f32) {
    for part in 0..u32::from(n) {
        let x = rows.m[a.at(part)];
        rows.put(to + part, each_lane(|i| f(x[i])));
    }
}

#[inline(always)]
fn each2(
    rows: &mut LaneRows<'_>,
    n: u8,
    to: u32,
    [a, b]: [Operand; 2],
    f: impl Fn(f32, f32) -> f32,
) {
    for part in 0..u32::from(n) {
        let (x, y) = (rows.m[a.at(part)], rows.m[b.at(part)]);
        rows.put(to + part, each_lane(|i| f(x[i], y[i])));
    }
}

#[inline(always)]
fn each3(
    rows: &mut LaneRows<'_>,
    n: u8,
    to: u32,
    [a, b, c]: [Operand; 3],
    f: impl Fn(f32, f32, f32) -> f32,
) {
    for part in 0..u32::from(n) {
        let (x, y, z) = (rows.m[a.at(part)], rows.m[b.at(part)], rows.m[c.at(part)]);
        rows.put(to + part, each_lane(|i| f(x[i], y[i], z[i])));
    }
}

/// As [`each1`], for a function of the lane's index and its word.
#[inline(always)]
fn each_row(rows: &mut LaneRows<'_>, n: u8, to: u32, a: Operand, f: impl Fn(usize, u32) -> u32) {
    for part in 0..u32::from(n) {
        let x = rows.words(a.at(part) as u32);
        rows.put_words(to + part, each_lane(|i| f(i, x[i])));
    }
}

/// Applies an expensive function: once if the arguments of all active lanes are the same, else once
/// for each active lane.
#[inline(always)]
fn costly<const K: usize>(
    rows: &mut LaneRows<'_>,
    n: u8,
    to: u32,
    operands: [Operand; K],
    f: impl Fn([f32; K]) -> f32,
) {
    for part in 0..u32::from(n) {
        let given: [Row; K] = operands.map(|operand| rows.m[operand.at(part)]);
        let of = |lane: usize| f(std::array::from_fn(|k| given[k][lane]));
        let mut result = [0.0; LANES];
        if given.iter().all(|row| rows.is_same(row)) {
            result = [of(rows.first()); LANES];
        } else {
            lanes_of(rows.mask).for_each(|lane| result[lane] = of(lane));
        }
        rows.put(to + part, result);
    }
}

/// A `match` with an arm for each named operation. In an arm the operation is a constant, so that
/// the compiler can vectorize the arm's loop.
macro_rules! by_name {
    ($ty:ident, $op:expr, [$($name:ident)*], |$known:ident| $quick:expr, $other:expr) => {
        match $op {
            $($ty::$name => { const $known: $ty = $ty::$name; $quick })*
            _ => $other,
        }
    };
}

fn unary(rows: &mut LaneRows<'_>, op: Unary, n: u8, to: u32, a: Operand) {
    by_name!(
        Unary, op,
        [Negate Abs Saturate Radians Degrees Ceil Floor Round Fract Trunc Sign Sqrt InverseSqrt],
        |OP| each1(rows, n, to, a, |x| f32::unary(OP, x, &mut false)),
        costly(rows, n, to, [a], |[x]| f32::unary(op, x, &mut false))
    );
}

fn binary(rows: &mut LaneRows<'_>, op: Binary, n: u8, to: u32, [a, b]: [Operand; 2]) {
    by_name!(
        Binary, op,
        [Add Subtract Multiply Divide Min Max Step],
        |OP| each2(rows, n, to, [a, b], |x, y| f32::binary(OP, x, y, &mut false)),
        costly(rows, n, to, [a, b], |[x, y]| f32::binary(op, x, y, &mut false))
    );
}

fn ternary(rows: &mut LaneRows<'_>, op: Ternary, n: u8, to: u32, operands: [Operand; 3]) {
    by_name!(
        Ternary, op,
        [Clamp Mix SmoothStep],
        |OP| each3(rows, n, to, operands, |x, y, z| f32::ternary(OP, x, y, z, &mut false)),
        costly(rows, n, to, operands, |[x, y, z]| f32::ternary(op, x, y, z, &mut false))
    );
}

fn compare(rows: &mut LaneRows<'_>, op: Compare, n: u8, to: u32, operands: [Operand; 2]) {
    by_name!(
        Compare, op,
        [Equal NotEqual Less LessEqual Greater],
        |OP| each2(rows, n, to, operands, |x, y| compared(OP, x, y)),
        each2(rows, n, to, operands, |x, y| compared(op, x, y))
    );
}

#[inline(always)]
fn compared(op: Compare, x: f32, y: f32) -> f32 {
    f32::from_bits(u32::from(f32::compare(op, x, y, &mut false)))
}

fn word_unary(rows: &mut LaneRows<'_>, op: Word1, n: u8, to: u32, a: Operand) {
    by_name!(
        Word1, op,
        [Negate Not LogicalNot Abs Truth],
        |OP| each1(rows, n, to, a, |x| f32::from_bits(word1(OP, x.to_bits()))),
        costly(rows, n, to, [a], |[x]| f32::from_bits(word1(op, x.to_bits())))
    );
}

fn word_binary(rows: &mut LaneRows<'_>, op: Word2, n: u8, to: u32, operands: [Operand; 2]) {
    by_name!(
        Word2, op,
        [Add Subtract Multiply And Or Xor ShiftLeft ShiftRightS ShiftRightU Equal NotEqual LessS
         LessU LessEqualS LessEqualU MinS MinU MaxS MaxU],
        |OP| each2(rows, n, to, operands, |x, y| {
            f32::from_bits(word2(OP, x.to_bits(), y.to_bits()))
        }),
        costly(rows, n, to, operands, |[x, y]| {
            f32::from_bits(word2(op, x.to_bits(), y.to_bits()))
        })
    );
}

fn convert(rows: &mut LaneRows<'_>, op: Convert, n: u8, to: u32, a: Operand) {
    by_name!(
        Convert, op,
        [FloatFromS FloatFromU SFromFloat UFromFloat BoolFromFloat],
        |OP| each1(rows, n, to, a, |x| convert_slot(OP, x, &mut false)),
        costly(rows, n, to, [a], |[x]| convert_slot(op, x, &mut false))
    );
}
