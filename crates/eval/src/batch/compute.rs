//! Runs instructions for all lanes at once: those that only read and write memory, functions of whole
//! vectors and matrices, accesses to textures, and derivatives. Each lane gets the bits that
//! [`crate::Machine`] would give it: the operations are the same functions.
//!
//! The memory of all lanes is [`Rows`]: a row of numbers for each slot, one number for each lane.

use crate::code::{
    Binary, Compare, Convert, DerivativeDirection, Geometry, Instruction, Operand, Product,
    Ternary, Unary, Word1, Word2,
};
use crate::machine;
use crate::machine::{
    Env, Slots, Watch, apply_access, convert_slot, coordinate_of, derivative_lanes, extract_bits,
    gradient_of, insert_bits, pack, word1, word2,
};
use crate::number::Number;

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
    one: impl Fn(&mut LaneView<'_>, u32),
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

/// How many lanes run together.
pub const LANES: usize = 16;

/// A slot of all lanes.
pub type Row = [f32; LANES];

/// A bit for each lane.
pub type Mask = u32;

pub const ALL: Mask = (1 << LANES) - 1;

/// A word for each lane: all bits set if the lane is in the mask, else 0.
pub fn kept_lanes(mask: Mask) -> [u32; LANES] {
    each_lane(|lane| 0u32.wrapping_sub(mask >> lane & 1))
}

/// The results of a function for each lane. It is a plain loop, which the compiler vectorizes.
#[inline(always)]
fn each_lane<T: Copy + Default>(f: impl Fn(usize) -> T) -> [T; LANES] {
    let mut row = [T::default(); LANES];
    for (lane, value) in row.iter_mut().enumerate() {
        *value = f(lane);
    }
    row
}

pub fn lanes_of(mask: Mask) -> impl Iterator<Item = usize> {
    (0..LANES).filter(move |lane| mask >> lane & 1 != 0)
}

/// The memory, and the lanes that an instruction writes.
pub struct LaneRows<'m> {
    pub m: &'m mut [Row],
    /// The active lanes. Writes leave the other lanes as they are, unless `whole` is set.
    pub mask: Mask,
    /// Set if no other lane has work left. Writes may then overwrite all lanes, which is faster.
    pub whole: bool,
    /// [`kept_lanes`] of the mask.
    keep: &'m [u32; LANES],
}

impl<'m> LaneRows<'m> {
    #[inline(always)]
    pub fn new(m: &'m mut [Row], mask: Mask, whole: bool, keep: &'m [u32; LANES]) -> Self {
        Self { m, mask, whole, keep }
    }

    #[inline(always)]
    pub fn row(&self, slot: u32) -> Row {
        self.m[slot as usize]
    }

    #[inline(always)]
    pub fn words(&self, slot: u32) -> [u32; LANES] {
        let row = &self.m[slot as usize];
        each_lane(|lane| row[lane].to_bits())
    }

    #[inline(always)]
    pub fn put(&mut self, slot: u32, row: Row) {
        let to = &mut self.m[slot as usize];
        if self.whole {
            *to = row;
        } else {
            let (keep, old) = (self.keep, *to);
            *to = each_lane(|lane| {
                let (new, old) = (row[lane].to_bits(), old[lane].to_bits());
                f32::from_bits(new & keep[lane] | old & !keep[lane])
            });
        }
    }

    #[inline(always)]
    pub fn put_words(&mut self, slot: u32, words: [u32; LANES]) {
        self.put(slot, each_lane(|lane| f32::from_bits(words[lane])));
    }

    /// The active lanes whose word in a slot is not 0.
    #[inline(always)]
    pub fn truth(&self, slot: u32) -> Mask {
        if let Some(word) = self.common(slot) {
            return if word == 0 { 0 } else { self.mask };
        }
        let words = self.words(slot);
        let mut truth = 0;
        for (lane, word) in words.iter().enumerate() {
            truth |= u32::from(*word != 0) << lane;
        }
        truth & self.mask
    }

    /// The first active lane.
    #[inline(always)]
    pub fn first(&self) -> usize {
        (self.mask.trailing_zeros() as usize).min(LANES - 1)
    }

    /// Whether all active lanes have the same bits in a row.
    #[inline(always)]
    pub fn is_same(&self, row: &Row) -> bool {
        let first = row[self.first()].to_bits();
        let mut other = 0;
        for (value, keep) in row.iter().zip(self.keep) {
            other |= (value.to_bits() ^ first) & keep;
        }
        other == 0
    }

    /// The word of a slot, if it is the same in all active lanes.
    #[inline(always)]
    pub fn common(&self, slot: u32) -> Option<u32> {
        let row = &self.m[slot as usize];
        self.is_same(row).then(|| row[self.first()].to_bits())
    }

    /// Copies slots; the ranges may overlap. If a range is not inside the memory, nothing is
    /// copied, as for a single lane.
    #[inline(always)]
    pub fn copy(&mut self, to: u32, from: u32, n: u32) {
        let (first, last) = (from as usize, from as usize + n as usize);
        if last > self.m.len() || to as usize + n as usize > self.m.len() {
            return;
        }
        if self.whole && n > 4 {
            return self.m.copy_within(first..last, to as usize);
        }
        for i in 0..n {
            let i = if to <= from { i } else { n - 1 - i };
            self.put(to + i, self.row(from + i));
        }
    }

    /// The memory of one lane.
    pub fn lane(&mut self, lane: usize) -> LaneView<'_> {
        LaneView { m: self.m, lane }
    }
}

/// The memory of one lane.
pub struct LaneView<'m> {
    m: &'m mut [Row],
    lane: usize,
}

impl LaneView<'_> {
    /// Copies slots of this lane, as [`LaneRows::copy`].
    pub fn copy(&mut self, to: u32, from: u32, n: u32) {
        let (to, from, n) = (to as usize, from as usize, n as usize);
        if from + n > self.m.len() || to + n > self.m.len() {
            return;
        }
        let lane = self.lane;
        let move_one = |i: usize, m: &mut [Row]| m[to + i][lane] = m[from + i][lane];
        if to <= from {
            (0..n).for_each(|i| move_one(i, self.m));
        } else {
            (0..n).rev().for_each(|i| move_one(i, self.m));
        }
    }
}

impl Slots<f32> for LaneView<'_> {
    #[inline(always)]
    fn get(&self, slot: u32) -> f32 {
        self.m[slot as usize][self.lane]
    }

    #[inline(always)]
    fn set(&mut self, slot: u32, value: f32) {
        self.m[slot as usize][self.lane] = value;
    }
}

/// A vector of up to four numbers, of all lanes.
type LaneVector = [Row; 4];

/// Runs one function on the slots `[to, a, b, c]`.
fn geometry(rows: &mut LaneRows<'_>, op: Geometry, n: u32, [to, a, b, c]: [u32; 4]) {
    let size = n as usize;
    match op {
        Geometry::Dot => rows.put(to, dot(&load(rows, a, n), &load(rows, b, n), size)),
        Geometry::Cross => {
            let (a, b) = (load(rows, a, 3), load(rows, b, 3));
            let minor = |i: usize, j: usize| {
                let (left, right) = (times(&a[i], &b[j]), times(&a[j], &b[i]));
                zip(&left, &right, |x, y| x - y)
            };
            [minor(1, 2), minor(2, 0), minor(0, 1)].into_iter().zip(to..).for_each(
                |(row, slot)| {
                    rows.put(slot, row);
                },
            );
        }
        Geometry::Distance => {
            let (a, b) = (load(rows, a, n), load(rows, b, n));
            let between = std::array::from_fn(|i| zip(&a[i], &b[i], |x, y| x - y));
            rows.put(to, length(&between, size));
        }
        Geometry::Length => rows.put(to, length(&load(rows, a, n), size)),
        Geometry::Normalize => {
            let vector = load(rows, a, n);
            let length = length(&vector, size);
            for (slot, row) in (to..to + n).zip(&vector) {
                rows.put(slot, zip(row, &length, |x, y| x / y));
            }
        }
        Geometry::Reflect => {
            let (e1, e2) = (load(rows, a, n), load(rows, b, n));
            let cosine = dot(&e2, &e1, size);
            let twice = each_lane(|i| 2.0 * cosine[i]);
            for (i, slot) in (0..size).zip(to..) {
                let along = times(&e2[i], &twice);
                rows.put(slot, zip(&e1[i], &along, |x, y| x - y));
            }
        }
        _ => one_by_one(rows, op, n, [to, a, b, c]),
    }
}

/// The functions that are seldom used, lane by lane.
fn one_by_one(rows: &mut LaneRows<'_>, op: Geometry, n: u32, [to, a, b, c]: [u32; 4]) {
    let (operands, results) = match op {
        Geometry::Determinant => (vec![(a, n * n)], 1),
        Geometry::Inverse => (vec![(a, n * n)], n * n),
        Geometry::Modf | Geometry::Frexp => (vec![(a, n)], 2 * n),
        Geometry::DotWord => (vec![(a, n), (b, n)], 1),
        Geometry::Ldexp => (vec![(a, n), (b, n)], n),
        Geometry::Refract => (vec![(a, n), (b, n), (c, 1)], n),
        _ => (vec![(a, n), (b, n), (c, n)], n),
    };
    let after: usize = operands.iter().map(|(_, n)| *n as usize).sum();
    let side = n as usize;
    on_each_lane(rows, &operands, (to, results), |m| {
        machine::geometry(m, op, side, [after, 0, side, 2 * side], &mut false);
    });
}

#[inline(always)]
fn load(rows: &LaneRows<'_>, from: u32, n: u32) -> LaneVector {
    std::array::from_fn(|i| if (i as u32) < n { rows.row(from + i as u32) } else { [0.0; LANES] })
}

#[inline(always)]
fn zip(a: &Row, b: &Row, f: impl Fn(f32, f32) -> f32) -> Row {
    each_lane(|i| f(a[i], b[i]))
}

#[inline(always)]
fn times(a: &Row, b: &Row) -> Row {
    zip(a, b, |x, y| x * y)
}

/// The products are added in order, as for a single lane.
#[inline(always)]
fn dot(a: &LaneVector, b: &LaneVector, n: usize) -> Row {
    let mut sum = times(&a[0], &b[0]);
    for i in 1..n {
        sum = zip(&sum, &times(&a[i], &b[i]), |x, y| x + y);
    }
    sum
}

#[inline(always)]
fn length(vector: &LaneVector, n: usize) -> Row {
    if n == 1 {
        return each_lane(|i| vector[0][i].abs());
    }
    let square = dot(vector, vector, n);
    each_lane(|i| square[i].sqrt())
}

/// Products of matrices and vectors, computed by columns of `b`.
fn matrix_product(
    rows: &mut LaneRows<'_>,
    op: Product,
    [inner, height, columns]: [u32; 3],
    [to, a, b]: [u32; 3],
) {
    // The distance in slots between the elements of a row of `a`. A vector on the left of a matrix
    // is a matrix of one row.
    let stride = if op == Product::VectorMatrix { 1 } else { height };
    for column in 0..columns {
        let right = load(rows, b + column * inner, inner);
        for row in 0..height {
            let mut left = [[0.0; LANES]; 4];
            for (k, part) in (0..inner).zip(&mut left) {
                *part = rows.row(a + k * stride + row);
            }
            rows.put(to + column * height + row, dot(&left, &right, inner as usize));
        }
    }
}

/// Runs an access for each active lane, without the gradients of a quad. `None` if it fails.
pub fn run_single(env: Env<'_>, index: u32, rows: &mut LaneRows<'_>, at: u32) -> Option<()> {
    let access = env.program.access(index)?;
    let mut watch = Watch::default();
    for lane in lanes_of(rows.mask) {
        apply_access(env, access, &mut rows.lane(lane), None, (at, &mut watch)).ok()?;
    }
    Some(())
}

/// Runs an access whose level of detail comes from the gradients within a quad, for the lanes of
/// `mask`. `None` if it fails.
pub fn run_quads(env: Env<'_>, index: u32, memory: &mut [Row], mask: Mask) -> Option<()> {
    let access = env.program.access(index)?;
    let mut watch = Watch::default();
    let keep = kept_lanes(ALL);
    let mut rows = LaneRows::new(memory, ALL, false, &keep);
    for quad in 0..LANES / 4 {
        let coordinates = std::array::from_fn(|place| {
            let lane = 4 * quad + place;
            (mask >> lane & 1 != 0).then(|| coordinate_of(access, &rows.lane(lane)))
        });
        for lane in lanes_of(mask & 0xf << (4 * quad)) {
            let gradient = gradient_of(&coordinates, lane & 3);
            apply_access(env, access, &mut rows.lane(lane), Some(gradient), (0, &mut watch))
                .ok()?;
        }
    }
    Some(())
}

/// Writes the derivative of a slot for the lanes of `mask`: the difference of two lanes of the
/// quad, or 0 if one of these is not in `mask`.
pub fn derivative(
    memory: &mut [Row],
    mask: Mask,
    axis: DerivativeDirection,
    coarse: bool,
    (to, from): (u32, u32),
) {
    let values = memory[from as usize];
    for lane in lanes_of(mask) {
        let quad = lane & !3;
        let along = |axis| {
            let (low, high) = derivative_lanes(lane & 3, axis, coarse);
            let (low, high) = (quad + low, quad + high);
            let are_there = mask >> low & mask >> high & 1 != 0;
            match are_there {
                true => f32::binary(Binary::Subtract, values[high], values[low], &mut false),
                false => 0.0,
            }
        };
        memory[to as usize][lane] = match axis {
            DerivativeDirection::Width => {
                let [x, y] = [DerivativeDirection::X, DerivativeDirection::Y]
                    .map(|axis| f32::unary(Unary::Abs, along(axis), &mut false));
                f32::binary(Binary::Add, x, y, &mut false)
            }
            axis => along(axis),
        };
    }
}
