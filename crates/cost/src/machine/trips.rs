//! How often loops run, as far as the code says it.
//!
//! A counter is a register that begins at a constant, is changed by a constant once in each trip,
//! and is compared with a limit where the loop is left. The limit is a constant, or a number that
//! is at most a constant: the compiler keeps `min(count, MAX_LIGHTS)`. Everything else is unknown.

use super::flow::{Flow, Loop};
use super::text::{Block, Comparison, Instruction, constant_of};

/// TripCount beyond which a loop counts as one of unknown length.
const MOST_TRIPS: u64 = 1 << 20;

/// How often a loop is gone round, from its header to its header.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TripCount {
    /// Exactly so often, if it is left where the counter is tested.
    Exactly { trips: u64, exit: usize },
    /// At most so often; the counter is tested in this block.
    AtMost { trips: u64, exit: usize },
    /// As often as the caller says.
    Given(u64),
    /// Not known: counted once.
    Unknown,
}

impl TripCount {
    /// The fewest and the most trips before the loop is left from a block. Nothing where it cannot
    /// be left from there, since the counter ends it before.
    pub(super) fn trips_to(self, flow: &Flow, from: usize) -> Option<(u64, u64)> {
        match self {
            Self::Exactly { trips, exit } if exit == from => Some((trips, trips)),
            // What is behind the test is reached once less.
            Self::Exactly { trips, exit } | Self::AtMost { trips, exit }
                if exit != from && flow.dominates(exit, from) =>
            {
                Some((0, trips.checked_sub(1)?))
            }
            Self::Exactly { trips, .. } | Self::AtMost { trips, .. } => Some((0, trips)),
            Self::Given(trips) => Some((trips, trips)),
            Self::Unknown => Some((1, 1)),
        }
    }
}

/// The trips of each loop. `given` has those of unknown loops, in the order of the code.
pub fn trip_counts(blocks: &[Block], flow: &Flow, given: &[u32]) -> Vec<TripCount> {
    let mut unknown = 0;
    let mut one = |index: usize| match (Counters { blocks, flow, index }).trips() {
        TripCount::Unknown => {
            let trips = given.get(unknown).or(given.last());
            unknown += 1;
            trips.map_or(TripCount::Unknown, |trips| TripCount::Given(u64::from(*trips)))
        }
        known => known,
    };
    (0..flow.loops.len()).map(&mut one).collect()
}

/// A number that a register holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Bound {
    most: i64,
    is_exact: bool,
}

/// Where an instruction stands: its block, and its index there.
type Place = (usize, usize);

struct Counters<'a> {
    blocks: &'a [Block],
    flow: &'a Flow,
    /// The loop.
    index: usize,
}

/// An exit of a loop by a comparison: the loop is left where it holds.
struct Test<'a> {
    comparison: Comparison,
    /// Whether the loop is left where the comparison does not hold.
    is_inverted: bool,
    left: &'a str,
    right: &'a str,
    at: Place,
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
            let limit = self.bound(limit, test.at, 8)?;
            let holds = |value: i64| {
                let [left, right] =
                    if *is_swapped { [limit.most, value] } else { [value, limit.most] };
                test.comparison.holds(left, right) != test.is_inverted
            };
            let trips = (0..MOST_TRIPS).find(|trip| holds(first + step * (*trip as i64)))?;
            // A lower limit must end the loop no later. That holds for a counter that rises.
            let is_certain = limit.is_exact || step > 0 && self.ends_sooner(&test, *is_swapped);
            is_certain.then_some((trips, limit.is_exact))
        })
    }

    /// Whether a smaller limit ends a rising counter's loop no later: the exit is `counter >= limit`
    /// or the like, which some limit and two counters around it show.
    fn ends_sooner(&self, test: &Test<'_>, is_swapped: bool) -> bool {
        let leaves = |counter: i64| {
            let [left, right] = if is_swapped { [100, counter] } else { [counter, 100] };
            test.comparison.holds(left, right) != test.is_inverted
        };
        leaves(102) && !leaves(98)
    }

    /// The comparison that decides whether a block leaves the loop, if it runs once in each trip.
    fn test_of(&self, exit: usize) -> Option<Test<'a>> {
        let is_each_turn = self.latches().all(|latch| self.flow.dominates(exit, latch));
        let block: &'a Block = self.blocks.get(exit).filter(|_| is_each_turn)?;
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
            return Some(Test { comparison, is_inverted, left, right, at: (exit, index) });
        }
        // The threads for which the comparison holds leave, and the wave leaves with the last.
        let is_rest = last.name.starts_with("s_andn2_b") || last.name.starts_with("s_and_not1_b");
        if !is_rest || on_one || !leaves_if_taken || !last.operand(2).starts_with("exec") {
            return None;
        }
        self.thread_test(exit, index)
    }

    /// A comparison of threads that precedes a place: in its block, or in the only one before.
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
        if !self.this().body.contains(&at.0) {
            return None;
        }
        let compare: &'a Instruction = &self.blocks[at.0].instructions[at.1];
        let comparison = Comparison::parse(compare.name.strip_prefix("v_cmpx_")?)?;
        let [.., left, right] = &compare.operands[..] else { return None };
        Some(Test { comparison, is_inverted: false, left, right, at })
    }

    /// Blocks from which the loop begins anew.
    fn latches(&self) -> impl Iterator<Item = usize> {
        let found = self.this();
        let sources = self.flow.sources[found.header].iter().copied();
        sources.filter(|source| found.body.contains(source))
    }

    /// The value of a counter at the first test, and its change in each trip.
    fn counter(&self, register: &str, test: Place) -> Option<(i64, i64)> {
        let changes: Vec<Place> =
            self.places_in(register, |block| self.this().body.contains(&block));
        let [change] = changes[..] else { return None };
        let is_once = self.flow.loop_of[change.0] == Some(self.index)
            && self.latches().all(|latch| self.flow.dominates(change.0, latch));
        if !is_once {
            return None;
        }
        let step = step_of(&self.blocks[change.0].instructions[change.1], register)?;
        let first = self.value_before(register)?;
        let is_before = match change.0 == test.0 {
            true => change.1 < test.1,
            false => self.flow.dominates(change.0, test.0),
        };
        // If the change is neither before the test nor behind it in each trip, it is not known.
        let is_behind = change.0 == test.0 || self.flow.dominates(test.0, change.0);
        match (is_before, is_behind) {
            (true, _) => Some((first + step, step)),
            (false, true) => Some((first, step)),
            (false, false) => None,
        }
    }

    /// The constant that a register holds where the loop is entered.
    fn value_before(&self, register: &str) -> Option<i64> {
        let place = self.last_before(register, (self.this().header, 0))?;
        let bound = self.bound_of_instruction(place, 8)?;
        bound.is_exact.then_some(bound.most)
    }

    /// What is known of an operand at a place.
    fn bound(&self, operand: &str, at: Place, depth: usize) -> Option<Bound> {
        if let Some(value) = constant_of(operand) {
            return Some(Bound { most: value, is_exact: true });
        }
        let place = self.last_before(operand, at)?;
        self.bound_of_instruction(place, depth.checked_sub(1)?)
    }

    fn bound_of_instruction(&self, place: Place, depth: usize) -> Option<Bound> {
        let instruction = &self.blocks[place.0].instructions[place.1];
        let operand = |index: usize| self.bound(instruction.operand(index), place, depth);
        let at_most = |most: i64| Some(Bound { most, is_exact: false });
        match instruction.name.as_str() {
            "s_mov_b32" | "s_movk_i32" | "v_mov_b32" => operand(1),
            "s_min_u32" | "s_min_i32" | "v_min_u32" | "v_min_i32" => {
                let known = [1, 2].into_iter().filter_map(operand).map(|bound| bound.most);
                at_most(known.min()?)
            }
            // The middle of three is at most the greater of two.
            "v_med3_i32" | "v_med3_u32" => {
                let known = [1, 2, 3].into_iter().filter_map(operand);
                let mut known: Vec<i64> = known.map(|bound| bound.most).collect();
                known.sort_unstable();
                at_most(*known.get(1)?)
            }
            "s_cselect_b32" => at_most(operand(1)?.most.max(operand(2)?.most)),
            _ => None,
        }
    }

    /// The last place that writes a register before another place, if every path comes by there.
    fn last_before(&self, register: &str, at: Place) -> Option<Place> {
        let writes = self.places_in(register, |_| true);
        let same = writes.iter().rev().find(|place| place.0 == at.0 && place.1 < at.1);
        if let Some(same) = same {
            return Some(*same);
        }
        // Code is laid out so that what is run later stands further down, except in a loop around:
        // there, a write behind the place comes before it in the next trip.
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
        // A loop around both comes by the write in each trip. One around the place alone must not
        // write.
        let is_fresh = outer.iter().filter(|index| !inside.contains(index)).all(|index| {
            writes.iter().all(|write| !self.flow.loops[*index].body.contains(&write.0))
        });
        (is_fresh && self.flow.dominates(place.0, at.0)).then_some(place)
    }

    /// Where a register is written, in the order of the code.
    fn places_in(&self, register: &str, wanted: impl Fn(usize) -> bool) -> Vec<Place> {
        let blocks = self.blocks.iter().enumerate().filter(|(block, _)| wanted(*block));
        let places = blocks.flat_map(|(block, found)| {
            let writes = found.instructions.iter().enumerate();
            let writes = writes.filter(|(_, instruction)| writes_register(instruction, register));
            writes.map(move |(index, _)| (block, index))
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
fn step_of(instruction: &Instruction, register: &str) -> Option<i64> {
    let sources: Vec<&str> = instruction
        .operands
        .iter()
        .skip(1)
        .map(String::as_str)
        .filter(|operand| !operand.starts_with("vcc") && !operand.contains('['))
        .collect();
    let other = |sources: &[&str]| match sources {
        [left, right] if *left == register => constant_of(right),
        [left, right] if *right == register => constant_of(left),
        _ => None,
    };
    match instruction.name.as_str() {
        "s_add_u32" | "s_add_i32" | "v_add_nc_u32" | "v_add_u32" | "v_add_nc_i32" => {
            other(&sources)
        }
        "s_addk_i32" => constant_of(sources.first()?),
        "s_sub_u32" | "s_sub_i32" | "v_sub_nc_u32" if sources.first() == Some(&register) => {
            other(&sources).map(|step| -step)
        }
        _ => None,
    }
}

/// Instructions that write none of their operands, by the beginning of the name.
const WRITE_NOTHING: &[&str] = &[
    "s_cmp",
    "s_bitcmp",
    "s_cbranch",
    "s_branch",
    "s_waitcnt",
    "s_nop",
    "exp",
    "buffer_store",
    "ds_write",
    "ds_store",
    "image_store",
    "global_store",
    "s_setreg",
    "s_sendmsg",
    "scratch_store",
    "tbuffer_store",
    "s_clause",
    "s_setprio",
    "s_endpgm",
];

/// Whether an instruction writes a register.
fn writes_register(instruction: &Instruction, register: &str) -> bool {
    // Most instructions do not even name the register where they write.
    let named = instruction.operands.iter().take(2);
    if !named.into_iter().any(|operand| contains_register(operand, register)) {
        return false;
    }
    let name = instruction.name.as_str();
    if WRITE_NOTHING.iter().any(|start| name.starts_with(start)) {
        return false;
    }
    // On RDNA, a comparison that sets the active threads has no register for its result.
    let is_bare = name.starts_with("v_cmpx_") && instruction.operands.len() < 3;
    // The second operand of an addition may be its carry.
    let has_carry = name.starts_with("v_add") || name.starts_with("v_sub") || name == "v_swap_b32";
    let count = if is_bare {
        0
    } else if has_carry {
        2
    } else {
        1
    };
    let written = instruction.operands.iter().take(count).enumerate();
    written.into_iter().any(|(index, operand)| {
        let is_sum = index == 1 && name != "v_swap_b32" && !operand.contains('[');
        !is_sum && contains_register(operand, register)
    })
}

/// Whether an operand such as `s[4:7]` contains a register such as `s5`.
fn contains_register(operand: &str, register: &str) -> bool {
    if operand == register {
        return true;
    }
    let range = operand.split_once('[').and_then(|(kind, rest)| {
        let (first, last) = rest.strip_suffix(']')?.split_once(':')?;
        Some((kind, first.parse::<u32>().ok()?, last.parse::<u32>().ok()?))
    });
    let single = register.split_at_checked(1);
    match (range, single) {
        (Some((kind, first, last)), Some((of, number))) => {
            let number = number.parse::<u32>();
            kind == of && number.is_ok_and(|number| (first..=last).contains(&number))
        }
        _ => false,
    }
}
