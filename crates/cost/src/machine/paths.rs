//! The cheapest and the dearest path through blocks.
//!
//! A wave takes both sides of an `if` where its threads differ, one of them where they agree, and
//! never none: the branch that skips the second side is not taken by a wave that skipped the first.
//! For each unit the range is that of all such paths. Paths are not checked for more: two branches
//! on the same condition count as independent.

use std::collections::BTreeMap;

use super::flow::Flow;
use super::trips::TripCount;
use super::units::{UNITS, Weights};
use super::{MachineCost, MachineError};

/// The least and the most of each unit over some paths.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Range {
    least: Weights,
    most: Weights,
}

impl Range {
    const NOTHING: Self =
        Self { least: Weights([0; UNITS.len()]), most: Weights([0; UNITS.len()]) };

    fn plus(self, other: Self) -> Self {
        Self { least: self.least.plus(other.least), most: self.most.plus(other.most) }
    }

    fn or(self, other: Self) -> Self {
        Self {
            least: self.least.with(other.least, i64::min),
            most: self.most.with(other.most, i64::max),
        }
    }
}

/// How a block is reached: its place, and whether by the branch that skips the side before it.
type Arrival = (usize, bool);

/// Ranges of the paths out of a loop, or out of the stage.
#[derive(Default)]
struct Region {
    /// From the entry to the entry again.
    around: Option<Range>,
    /// From the entry to each place outside, and the block from which it is left.
    exits: BTreeMap<(usize, Arrival), Range>,
    /// From the entry to the end of the stage, which is never inside of a loop.
    end: Option<Range>,
}

/// The range of all paths through a stage.
pub fn count_paths(
    flow: &Flow,
    weights: &[Weights],
    loops: Vec<TripCount>,
) -> Result<MachineCost, MachineError> {
    let whole = Walk { flow, weights, loops: &loops }.region(None);
    let Range { least, most } = whole.end.ok_or(MachineError::NoEnd)?;
    Ok(MachineCost { least, most, loops })
}

struct Walk<'a> {
    flow: &'a Flow,
    weights: &'a [Weights],
    loops: &'a [TripCount],
}

impl Walk<'_> {
    /// The paths through a loop once, or through the whole stage.
    fn region(&self, of: Option<usize>) -> Region {
        let flow = self.flow;
        let entry = match of {
            Some(index) => flow.loops[index].header,
            None => flow.order.first().copied().unwrap_or_default(),
        };
        let mut region = Region::default();
        let mut arrivals = BTreeMap::from([((entry, false), Range::NOTHING)]);
        for block in flow.order.iter().copied() {
            let [plain, skipped] =
                [false, true].map(|skips| arrivals.get(&(block, skips)).copied());
            let Some(either) = join(plain, skipped) else { continue };
            // A loop within this one counts as a single step from its header.
            let inner = flow.loop_of[block]
                .filter(|inner| Some(*inner) != of && flow.loops[*inner].header == block);
            if let Some(inner) = inner {
                for ((from, to), range) in self.iterated(inner) {
                    self.arrive(of, &mut region, &mut arrivals, from, to, either.plus(range));
                }
                continue;
            }
            let own = Range { least: self.weights[block], most: self.weights[block] };
            if flow.edges[block].is_empty() {
                region.end = join(region.end, Some(either.plus(own)));
            }
            for edge in &flow.edges[block] {
                let is_second = edge.skips && flow.swaps[block];
                let Some(before) = (if is_second { plain } else { Some(either) }) else { continue };
                let to = (edge.to, edge.skips && flow.swaps[edge.to]);
                self.arrive(of, &mut region, &mut arrivals, block, to, before.plus(own));
            }
        }
        region
    }

    /// Takes paths to a place: on in this region, around its loop, or out of it.
    fn arrive(
        &self,
        of: Option<usize>,
        region: &mut Region,
        arrivals: &mut BTreeMap<Arrival, Range>,
        from: usize,
        to: Arrival,
        range: Range,
    ) {
        let around = of.map(|index| &self.flow.loops[index]);
        match around {
            Some(around) if around.header == to.0 => {
                region.around = join(region.around, Some(range));
            }
            Some(around) if !around.body.contains(&to.0) => {
                let known = region.exits.entry((from, to)).or_insert(range);
                *known = known.or(range);
            }
            _ => {
                let known = arrivals.entry(to).or_insert(range);
                *known = known.or(range);
            }
        }
    }

    /// The paths through all iterations of a loop to each of its exits.
    fn iterated(&self, inner: usize) -> BTreeMap<(usize, Arrival), Range> {
        let once = self.region(Some(inner));
        let around = once.around.unwrap_or(Range::NOTHING);
        let iterated = |from: usize, range: Range| {
            let is_behind = range.most.total().saturating_mul(2) > around.most.total();
            let (least, most) = self.loops[inner].trips_to(self.flow, from, is_behind)?;
            let trips = Range { least: around.least.times(least), most: around.most.times(most) };
            Some(trips.plus(range))
        };
        let exits = once.exits.into_iter();
        exits.filter_map(|((from, to), range)| Some(((from, to), iterated(from, range)?))).collect()
    }
}

fn join(one: Option<Range>, other: Option<Range>) -> Option<Range> {
    match (one, other) {
        (Some(one), Some(other)) => Some(one.or(other)),
        (one, other) => one.or(other),
    }
}
