//! Functions of whole vectors and matrices, for all lanes at once.

use super::super::code::{Geometry, Product};
use super::super::machine;
use super::compute::on_each_lane;
use super::rows::{LANES, LaneRows, Row, each_lane};

/// A vector of up to four numbers, of all lanes.
type LaneVector = [Row; 4];

/// Runs one function on the slots `[to, a, b, c]`.
pub fn geometry(rows: &mut LaneRows<'_>, op: Geometry, n: u32, [to, a, b, c]: [u32; 4]) {
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
pub fn matrix_product(
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
