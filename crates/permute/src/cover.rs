//! A small set of valid points that covers every pair of values of two axes that occurs in any
//! valid point (pairwise testing). Most faults need no more than two axes to show: Kuhn, Wallace
//! and Gallo, "Software Fault Interactions and Implications for Software Testing", 2004.

use std::collections::BTreeSet;

use super::axis::ValueSet;
use super::key::Assignment;
use super::manifest::Program;
use super::space::{Slice, SliceLists, Space};

/// Two axes, the first before the second, with the ordinal of a value of each.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ValuePair {
    /// An axis and the ordinal of its value.
    pub first: (usize, usize),
    /// Another axis and the ordinal of its value.
    pub second: (usize, usize),
}

/// A covering set.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Cover {
    /// In the order found: each covers a pair that those before it do not.
    pub points: Vec<Assignment>,
    /// Pairs that no valid point has.
    pub infeasible: Vec<ValuePair>,
}

/// Covers every pair of values that the constraints allow; the lists of the space are ignored.
///
/// The search is greedy and deterministic. It pins the first uncovered pair. Then each other axis
/// takes the value that covers the most uncovered pairs and still leads to a valid point.
pub fn pairwise(space: &Space) -> Cover {
    let mut left = allowed_pairs(space);
    let mut cover = Cover { points: Vec::new(), infeasible: Vec::new() };
    if left.is_empty() {
        cover.points = cover_without_pairs(space);
    }
    while let Some(pair) = left.first().copied() {
        match covering_point(space, pair, &left) {
            Some(point) => {
                left.retain(|pair| !has_pair(&point, *pair));
                cover.points.push(point);
            }
            None => {
                left.remove(&pair);
                cover.infeasible.push(pair);
            }
        }
    }
    cover
}

/// The space of a program in which only a covering set ships.
pub fn covering_space(program: &Program) -> Space {
    let space = &program.space;
    let values = space.axes().iter().map(|axis| ValueSet::full(axis.values.len())).collect();
    let everything = Slice { values, span: program.span };
    let include = pairwise(space).points;
    let lists = SliceLists { only: Vec::new(), exclude: vec![everything], include };
    let covering = Space::new(space.axes().to_vec(), space.constraints().to_vec(), lists);
    // The axes and constraints were read without errors. If the list of points is too complex to
    // count, all permutations ship.
    let mut covering = covering.unwrap_or_else(|_| space.clone());
    covering.undeclared = space.undeclared;
    covering.features = space.features.clone();
    covering
}

/// The cover of a space with fewer than two axes: each valid value of its axis, or its only point.
fn cover_without_pairs(space: &Space) -> Vec<Assignment> {
    match space.axes() {
        [axis] => axis
            .domain()
            .iter()
            .filter_map(|ordinal| space.pick_valid(&[(0, ordinal)], |_, open| first_value(open)))
            .collect(),
        _ => space.pick_valid(&[], |_, open| first_value(open)).into_iter().collect(),
    }
}

fn allowed_pairs(space: &Space) -> BTreeSet<ValuePair> {
    let values = space.axes().iter().enumerate().flat_map(|(index, axis)| {
        axis.domain().iter().map(move |ordinal| (index, ordinal)).collect::<Vec<_>>()
    });
    let values: Vec<(usize, usize)> = values.collect();
    let second = |first: (usize, usize)| {
        values
            .iter()
            .filter(move |second| second.0 > first.0)
            .map(move |second| ValuePair { first, second: *second })
    };
    values.iter().flat_map(|first| second(*first)).collect()
}

fn covering_point(
    space: &Space,
    pair: ValuePair,
    left: &BTreeSet<ValuePair>,
) -> Option<Assignment> {
    let pins = [pair.first, pair.second];
    let mut chosen = pins.to_vec();
    space.pick_valid(&pins, |axis, open| {
        let gain = |ordinal: usize| {
            chosen
                .iter()
                .filter(|other| left.contains(&ordered_pair(**other, (axis, ordinal))))
                .count()
        };
        let best = open
            .iter()
            .max_by_key(|ordinal| (gain(*ordinal), std::cmp::Reverse(*ordinal)))
            .unwrap_or(0);
        if !pins.iter().any(|(pinned, _)| *pinned == axis) {
            chosen.push((axis, best));
        }
        best
    })
}

fn has_pair(point: &Assignment, pair: ValuePair) -> bool {
    [pair.first, pair.second].iter().all(|(axis, ordinal)| point.ordinal(*axis) == *ordinal)
}

fn ordered_pair(one: (usize, usize), other: (usize, usize)) -> ValuePair {
    ValuePair { first: one.min(other), second: one.max(other) }
}

fn first_value(open: ValueSet) -> usize {
    open.iter().next().unwrap_or(0)
}
