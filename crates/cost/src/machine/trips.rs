//! How often loops run, as far as the code says it.
//!
//! A counter is a register that begins at a constant, is changed by a constant once in each
//! iteration, and is compared with a limit where the loop is left. The limit is a constant, or a
//! number that is at most a constant: the compiler keeps `min(count, MAX_LIGHTS)`. A vector
//! register has a value for each thread: what is known of it must hold for all threads in the loop.
//! Everything else is unknown.

use super::flow::{Flow, Loop};
use super::interval::{Interval, immediate_of};
use super::masks::Masks;
use super::registers::{Registers, written_registers};
use super::text::{Block, Comparison, Instruction};

/// Iterations beyond which a loop counts as one of unknown length.
const MOST_TRIPS: u64 = 1 << 20;

/// How often a loop is gone round, from its header to its header.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TripCount {
    /// Exactly so often, if it is left where the counter is tested.
    Exactly { trips: u64, exit: usize },
    /// At most so often; the counter is tested in this block.
    AtMost { trips: u64, exit: usize },
    /// The part before an exit, or the one behind it, whichever has more to do, runs so often, as
    /// the caller says.
    Given(u64),
    /// Not known: the same, once.
    Unknown,
}

impl TripCount {
    /// The fewest and the most trips before the loop is left from a block. Nothing where it cannot
    /// be left from there, since the counter ends it before. `is_behind` says whether most of an
    /// iteration is over where it is left: this part runs once more than the loop is gone round.
    pub(super) fn trips_to(self, flow: &Flow, from: usize, is_behind: bool) -> Option<(u64, u64)> {
        let all = |count: u64| count.saturating_sub(u64::from(is_behind));
        match self {
            Self::Exactly { trips, exit } if exit == from => Some((trips, trips)),
            // What is behind the test is reached once less.
            Self::Exactly { trips, exit } | Self::AtMost { trips, exit }
                if exit != from && flow.dominates(exit, from) =>
            {
                Some((0, trips.checked_sub(1)?))
            }
            Self::Exactly { trips, .. } | Self::AtMost { trips, .. } => Some((0, trips)),
            Self::Given(count) => Some((all(count), all(count))),
            Self::Unknown => Some((all(1), all(1))),
        }
    }
}

/// The trips of each loop, in waves of so many threads. `given` has those of unknown loops, in the
/// order of the code.
pub fn trip_counts(blocks: &[Block], flow: &Flow, wave: u32, given: &[u32]) -> Vec<TripCount> {
    if flow.loops.is_empty() {
        return Vec::new();
    }
    let masks = Masks::of(blocks, flow, wave);
    let mut unknown = 0;
    let mut one = |index: usize| {
        let counters = Counters { blocks, flow, masks: &masks, wave, index };
        match counters.trips() {
            TripCount::Unknown => {
                let count = given.get(unknown).or(given.last());
                unknown += 1;
                count.map_or(TripCount::Unknown, |count| TripCount::Given(u64::from(*count)))
            }
            known => known,
        }
    };
    (0..flow.loops.len()).map(&mut one).collect()
}

/// Where an instruction stands: its block, and its index there.
type Place = (usize, usize);

/// How many instructions are followed back to find what a register holds.
const DEPTH: usize = 8;

struct Counters<'a> {
    blocks: &'a [Block],
    flow: &'a Flow,
    masks: &'a Masks<'a>,
    wave: u32,
    /// The loop.
    index: usize,
}

/// An exit of a loop by a comparison: the loop is left where it holds.
struct Test<'a> {
    comparison: Comparison,
    /// Whether the loop is left where the comparison does not hold.
    is_inverted: bool,
    name: &'a str,
    left: &'a str,
    right: &'a str,
    at: Place,
}

impl Test<'_> {
    /// Whether the loop is left with these numbers on the sides of the counter and of the limit.
    fn leaves(&self, counter: i64, limit: i64, is_swapped: bool) -> bool {
        let [left, right] = if is_swapped { [limit, counter] } else { [counter, limit] };
        self.comparison.holds(left, right) != self.is_inverted
    }

    /// Whether a smaller limit ends the loop no later: the exit is `counter >= limit` or the like,
    /// which a limit and two counters around it show.
    fn ends_sooner(&self, is_swapped: bool) -> bool {
        self.leaves(102, 100, is_swapped) && !self.leaves(98, 100, is_swapped)
    }
}

impl<'a> Counters<'a> {
    fn this(&self) -> &'a Loop {
        &self.flow.loops[self.index]
    }

    fn trips(&self) -> TripCount {
        let exits: Vec<usize> =
            self.this().body.iter().copied().filter(|block| self.leaves(*block)).collect();
        let counted = exits.iter().filter_map(|exit| Some((*exit, self.exit_trips(*exit)?)));
        let fewest = counted.min_by_key(|(_, (trips, is_exact))| (*trips, !is_exact));
        match fewest {
            Some((exit, (trips, true))) => TripCount::Exactly { trips, exit },
            Some((exit, (trips, false))) => TripCount::AtMost { trips, exit },
            None => TripCount::Unknown,
        }
    }

    fn leaves(&self, block: usize) -> bool {
        self.flow.edges[block].iter().any(|edge| !self.this().body.contains(&edge.to))
    }

    /// The trips before the exit of a block is taken, and whether that is exact.
    fn exit_trips(&self, exit: usize) -> Option<(u64, bool)> {
        let test = self.test_of(exit)?;
        // The counter may stand on either side.
        let sides = [(test.left, test.right, false), (test.right, test.left, true)];
        sides.iter().find_map(|(counter, limit, is_swapped)| {
            let (first, step) = self.counter(counter, test.at)?;
            let limit = self.interval(test.name, limit, test.at, DEPTH)?;
            // An unsigned comparison takes a negative number for a large one.
            let is_ordered = limit.is_exact() || test.comparison.is_signed() || limit.least >= 0;
            let is_certain = limit.is_exact() || test.ends_sooner(*is_swapped);
            if !is_ordered || !is_certain {
                return None;
            }
            // The register has 32 bits.
            let value = |trip: u64| i64::from((first + step * (trip as i64)) as i32);
            let leaves = |trip: &u64| test.leaves(value(*trip), limit.most, *is_swapped);
            Some(((0..MOST_TRIPS).find(leaves)?, limit.is_exact()))
        })
    }

    /// The comparison that decides whether a block leaves the loop, if it runs once in each
    /// iteration.
    fn test_of(&self, exit: usize) -> Option<Test<'a>> {
        let is_each_time = self.latches().all(|latch| self.flow.dominates(exit, latch));
        let block: &'a Block = self.blocks.get(exit).filter(|_| is_each_time)?;
        let (branch, before) = block.instructions.split_last()?;
        let taken = self.flow.edges[exit].first()?;
        let leaves_if_taken = !self.this().body.contains(&taken.to);
        let on_one = match branch.name.as_str() {
            "s_cbranch_scc1" => true,
            "s_cbranch_scc0" => false,
            _ => return None,
        };
        let (index, last) = last_flag(before)?;
        if let Some(name) = last.name.strip_prefix("s_cmp_").or(last.name.strip_prefix("s_cmpk_")) {
            let comparison = Comparison::parse(name)?;
            let is_inverted = leaves_if_taken != on_one;
            let (left, right) = (last.operand(0), last.operand(1));
            let name = &last.name;
            return Some(Test { comparison, is_inverted, name, left, right, at: (exit, index) });
        }
        // The threads for which the comparison holds leave, and the wave leaves with the last.
        let is_rest = last.name.starts_with("s_andn2_b") || last.name.starts_with("s_and_not1_b");
        if !is_rest || on_one || !leaves_if_taken || !last.operand(2).starts_with("exec") {
            return None;
        }
        self.thread_test(exit, index)
    }

    /// A comparison of threads that precedes a place, in its block or in the only one before, if
    /// every thread in the loop is compared and those that do not leave go on.
    fn thread_test(&self, block: usize, index: usize) -> Option<Test<'a>> {
        let found = |block: usize, end: usize| {
            let instructions: &'a [Instruction] = &self.blocks[block].instructions;
            let at = instructions[..end].iter().rposition(|it| it.name.starts_with("v_cmpx_"))?;
            Some((block, at))
        };
        let before = || {
            let [only] = self.flow.sources[block][..] else { return None };
            found(only, self.blocks[only].instructions.len())
        };
        let at = found(block, index).or_else(before)?;
        let compare: &'a Instruction = &self.blocks[at.0].instructions[at.1];
        let staying = self.blocks[block].instructions[index].operand(1);
        let staying = self.masks.held(block, index, Registers::parse(staying)?)?;
        let (compared, leaving) =
            (self.masks.active(at.0, at.1)?, self.masks.active(at.0, at.1 + 1)?);
        let is_whole = compared.contains(&staying)
            && self.masks.active(block, index)? == leaving
            && self.this().body.contains(&at.0)
            && self.is_of_all(at);
        let comparison = Comparison::parse(compare.name.strip_prefix("v_cmpx_")?)?;
        let [.., left, right] = &compare.operands[..] else { return None };
        let name = &compare.name;
        is_whole.then_some(Test { comparison, is_inverted: false, name, left, right, at })
    }

    /// Whether all threads that go round again are active at a place in the loop.
    fn is_of_all(&self, at: Place) -> bool {
        let Some(active) = self.masks.active(at.0, at.1) else { return false };
        self.latches().all(|latch| {
            self.masks.active_at_end(latch).is_some_and(|staying| active.contains(&staying))
        })
    }

    /// Blocks from which the loop begins anew.
    fn latches(&self) -> impl Iterator<Item = usize> {
        let found = self.this();
        let sources = self.flow.sources[found.header].iter().copied();
        sources.filter(|source| found.body.contains(source))
    }

    /// The value of a counter at the first test, and its change in each iteration.
    fn counter(&self, register: &str, test: Place) -> Option<(i64, i64)> {
        let register = Registers::parse(register)?;
        let changes: Vec<Place> =
            self.places_in(register, |block| self.this().body.contains(&block));
        let [change] = changes[..] else { return None };
        let is_once = self.flow.loop_of[change.0] == Some(self.index)
            && self.latches().all(|latch| self.flow.dominates(change.0, latch))
            && (!register.is_vector() || self.is_of_all(change));
        if !is_once {
            return None;
        }
        let step = step_of(&self.blocks[change.0].instructions[change.1], register)?;
        let header = (self.this().header, 0);
        let first = self.value_of(self.last_before(register, header)?, DEPTH)?;
        let first = first.is_exact().then_some(first.most)?;
        let is_before = match change.0 == test.0 {
            true => change.1 < test.1,
            false => self.flow.dominates(change.0, test.0),
        };
        // If the change is neither before the test nor behind it in each iteration, it is not
        // known.
        let is_behind = change.0 == test.0 || self.flow.dominates(test.0, change.0);
        match (is_before, is_behind) {
            (true, _) => Some((first + step, step)),
            (false, true) => Some((first, step)),
            (false, false) => None,
        }
    }

    /// What is known of an operand of an instruction at a place.
    fn interval(&self, name: &str, operand: &str, at: Place, depth: usize) -> Option<Interval> {
        if let Some(value) = immediate_of(name, operand) {
            return Some(Interval::exactly(value));
        }
        let place = self.last_before(Registers::parse(operand)?, at)?;
        self.value_of(place, depth.checked_sub(1)?)
    }

    /// What is known of the number that an instruction writes.
    fn value_of(&self, place: Place, depth: usize) -> Option<Interval> {
        let instruction = &self.blocks[place.0].instructions[place.1];
        let name = instruction.name.as_str();
        Interval::written(name, |index| {
            self.interval(name, instruction.operand(index), place, depth)
        })
    }

    /// The last place that writes a register before another place, if every path comes by there. A
    /// vector register must be written there for all threads that are active at the other place.
    fn last_before(&self, register: Registers, at: Place) -> Option<Place> {
        let place = self.last_write(register, at)?;
        let is_whole = || {
            let written = self.masks.active(place.0, place.1)?;
            Some(written.contains(&self.masks.active(at.0, at.1)?))
        };
        (!register.is_vector() || is_whole()?).then_some(place)
    }

    fn last_write(&self, register: Registers, at: Place) -> Option<Place> {
        let writes = self.places_in(register, |_| true);
        let same = writes.iter().rev().find(|place| place.0 == at.0 && place.1 < at.1);
        if let Some(same) = same {
            return Some(*same);
        }
        // Code is laid out so that what is run later stands further down, except in a loop around:
        // there, a write behind the place comes before it in the next iteration.
        let around = |block: usize| {
            let up = |at: &usize| self.flow.loops[*at].parent;
            let loops: Vec<usize> = std::iter::successors(self.flow.loop_of[block], up).collect();
            loops
        };
        let is_header = at.1 == 0 && self.this().header == at.0;
        let mut outer = around(at.0);
        if is_header {
            outer.retain(|index| *index != self.index);
        }
        let place = writes.iter().rev().find(|place| place.0 < at.0).copied()?;
        let inside = around(place.0);
        // A loop around both comes by the write in each iteration. One around the place alone must
        // not write.
        let is_fresh = outer.iter().filter(|index| !inside.contains(index)).all(|index| {
            writes.iter().all(|write| !self.flow.loops[*index].body.contains(&write.0))
        });
        (is_fresh && self.flow.dominates(place.0, at.0)).then_some(place)
    }

    /// Where a register is written, in the order of the code.
    fn places_in(&self, register: Registers, wanted: impl Fn(usize) -> bool) -> Vec<Place> {
        let blocks = self.blocks.iter().enumerate().filter(|(block, _)| wanted(*block));
        let writes = |instruction: &Instruction| {
            let written = written_registers(instruction, self.wave);
            written.into_iter().any(|written| written.overlap(register))
        };
        let places = blocks.flat_map(|(block, found)| {
            let instructions = found.instructions.iter().enumerate();
            let written = instructions.filter(|(_, instruction)| writes(instruction));
            written.map(move |(index, _)| (block, index))
        });
        places.collect()
    }
}

/// The last instruction that sets the scalar condition. Instructions of other units do not.
fn last_flag(before: &[Instruction]) -> Option<(usize, &Instruction)> {
    let keeps = |instruction: &Instruction| {
        let name = instruction.name.as_str();
        !name.starts_with("s_") || KEEP_FLAG.iter().any(|start| name.starts_with(start))
    };
    before.iter().enumerate().rev().find(|(_, instruction)| !keeps(instruction))
}

/// Scalar instructions that leave the scalar condition as it is.
const KEEP_FLAG: [&str; 9] = [
    "s_mov",
    "s_waitcnt",
    "s_load",
    "s_buffer_load",
    "s_clause",
    "s_nop",
    "s_mul_i32",
    "s_cselect",
    "s_setprio",
];

/// The change of a register by an instruction that adds a constant to it.
fn step_of(instruction: &Instruction, register: Registers) -> Option<i64> {
    let name = instruction.name.as_str();
    let is_it = |operand: &str| Registers::parse(operand) == Some(register);
    let constant = |operand: &str| immediate_of(name, operand);
    // Without the carry.
    let sources: Vec<&str> = instruction
        .operands
        .iter()
        .skip(1)
        .map(String::as_str)
        .filter(|operand| !operand.starts_with("vcc") && !operand.contains('['))
        .collect();
    match (name, &sources[..]) {
        (
            "s_add_u32" | "s_add_i32" | "v_add_nc_u32" | "v_add_u32" | "v_add_nc_i32",
            [left, right],
        ) => match (is_it(left), is_it(right)) {
            (true, false) => constant(right),
            (false, true) => constant(left),
            _ => None,
        },
        ("s_addk_i32", [step]) => constant(step),
        ("s_sub_u32" | "s_sub_i32" | "v_sub_nc_u32" | "v_sub_u32", [left, right])
            if is_it(left) =>
        {
            constant(right).map(|step| -step)
        }
        _ => None,
    }
}
