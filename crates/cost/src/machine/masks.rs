//! Which threads are active, as far as one set of them is known to lie within another.
//!
//! A vector instruction writes the registers of active threads only. So a number is one of all
//! threads of a loop only if all were active where it was written. The masks of threads are named,
//! not computed: an instruction that takes threads away makes a new mask within the old one, a copy
//! has the name of its source, and where paths meet, the new mask lies within what they have in
//! common. Of everything else, such as a union, nothing is known.

use std::collections::{BTreeMap, BTreeSet};
use std::rc::Rc;

use super::flow::Flow;
use super::registers::{Registers, written_registers};
use super::text::{Block, Instruction};

/// Names a mask by the place that makes it: the block, the index of the instruction, and the
/// registers that it writes. A block that begins with a mask of its own has the index of no
/// instruction.
type Name = Option<(usize, usize, Registers)>;

/// The name of the mask of all threads.
const ALL: Name = None;

const BEGIN: usize = usize::MAX;

/// A set of threads, by its name and those of all sets around it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Mask {
    own: Name,
    around: Rc<BTreeSet<Name>>,
}

impl Mask {
    /// The mask that is made at a place, within others.
    fn named(block: usize, index: usize, to: Registers, mut around: BTreeSet<Name>) -> Self {
        let own = Some((block, index, to));
        around.extend([ALL, own]);
        Self { own, around: Rc::new(around) }
    }

    /// Whether every thread of another mask is one of this.
    pub fn contains(&self, other: &Self) -> bool {
        other.around.contains(&self.own)
    }
}

/// The masks that registers hold; `exec` is one of them. What is not listed is not known.
type Held = BTreeMap<Registers, Mask>;

/// Blocks that begin a loop, with registers that do not keep their masks around it.
type Disproved = BTreeSet<(usize, Registers)>;

/// The masks at each place of a stage.
pub struct Masks<'a> {
    blocks: &'a [Block],
    wave: u32,
    /// At the beginning of each block; nothing for blocks that are not reached.
    begin: Vec<Option<Held>>,
}

impl<'a> Masks<'a> {
    pub fn of(blocks: &'a [Block], flow: &Flow, wave: u32) -> Self {
        let begin = vec![None; blocks.len()];
        let mut masks = Self { blocks, wave, begin };
        masks.find(flow);
        masks
    }

    /// The active threads before an instruction. Nothing for one that is not reached.
    pub fn active(&self, block: usize, index: usize) -> Option<Mask> {
        self.held(block, index, Registers::exec(self.wave))
    }

    /// The active threads behind the last instruction of a block.
    pub fn active_at_end(&self, block: usize) -> Option<Mask> {
        self.active(block, self.blocks[block].instructions.len())
    }

    /// The mask that registers hold before an instruction, if it is known.
    pub fn held(&self, block: usize, index: usize, registers: Registers) -> Option<Mask> {
        let mut held = self.begin[block].clone()?;
        self.run(block, index, &mut held);
        held.get(&registers).cloned()
    }

    /// Finds the masks at the beginning of each block. A loop is entered with what holds before it,
    /// as long as what comes round agrees; otherwise the loop is gone through again without it.
    fn find(&mut self, flow: &Flow) {
        let mut disproved = Disproved::new();
        loop {
            for block in flow.order.iter().copied() {
                self.begin[block] = Some(self.joined(flow, block, &disproved));
            }
            let before = disproved.len();
            for found in &flow.loops {
                self.disprove(flow, found.header, &mut disproved);
            }
            if disproved.len() == before {
                return;
            }
        }
    }

    /// What holds where the paths into a block meet, as far as they come from above.
    fn joined(&self, flow: &Flow, block: usize, disproved: &Disproved) -> Held {
        let exec = Registers::exec(self.wave);
        let is_header = flow.loops.iter().any(|found| found.header == block);
        let above = flow.sources[block].iter().filter(|source| !flow.dominates(block, **source));
        let ends: Vec<Held> = above.map(|source| self.end(*source)).collect();
        let Some((first, rest)) = ends.split_first() else {
            let start = Mask::named(block, BEGIN, exec, BTreeSet::new());
            return Held::from([(exec, start)]);
        };
        let mut held = Held::new();
        for (registers, mask) in first {
            let Some(others) =
                rest.iter().map(|end| end.get(registers)).collect::<Option<Vec<&Mask>>>()
            else {
                continue;
            };
            let is_kept = !disproved.contains(&(block, *registers));
            let is_same = others.iter().all(|other| *other == mask);
            let is_exec = *registers == exec;
            if is_same && is_kept && !(is_header && is_exec) {
                held.insert(*registers, mask.clone());
            } else if is_exec {
                // A loop begins with fewer threads each time.
                let common = |around: BTreeSet<Name>, other: &&Mask| &around & &other.around;
                let around = match is_kept {
                    true => others.iter().fold((*mask.around).clone(), common),
                    false => BTreeSet::new(),
                };
                held.insert(exec, Mask::named(block, BEGIN, exec, around));
            }
        }
        held
    }

    fn end(&self, block: usize) -> Held {
        let mut held = self.begin[block].clone().unwrap_or_default();
        self.run(block, self.blocks[block].instructions.len(), &mut held);
        held
    }

    /// Notes what the ends of a loop's iterations do not keep.
    fn disprove(&self, flow: &Flow, header: usize, disproved: &mut Disproved) {
        let exec = Registers::exec(self.wave);
        let held = self.begin[header].clone().unwrap_or_default();
        let latches = flow.sources[header].iter().filter(|source| flow.dominates(header, **source));
        for latch in latches {
            let end = self.end(*latch);
            for (registers, mask) in &held {
                let is_kept = end.get(registers).is_some_and(|end| match *registers == exec {
                    true => mask.contains(end),
                    false => end == mask,
                });
                if !is_kept {
                    disproved.insert((header, *registers));
                }
            }
        }
    }

    /// Changes what is held by the first instructions of a block.
    fn run(&self, block: usize, count: usize, held: &mut Held) {
        let blocks = self.blocks;
        for (index, instruction) in blocks[block].instructions.iter().take(count).enumerate() {
            let written = written_registers(instruction, self.wave);
            let made: Vec<(Registers, Option<Mask>)> = written
                .iter()
                .map(|to| (*to, self.made(block, index, instruction, *to, held)))
                .collect();
            held.retain(|registers, _| !written.iter().any(|to| to.overlap(*registers)));
            for (to, mask) in made {
                held.extend(mask.map(|mask| (to, mask)));
            }
            let exec = Registers::exec(self.wave);
            held.entry(exec).or_insert_with(|| Mask::named(block, index, exec, BTreeSet::new()));
        }
    }

    /// The mask that an instruction writes to registers.
    fn made(
        &self,
        block: usize,
        index: usize,
        instruction: &Instruction,
        to: Registers,
        held: &Held,
    ) -> Option<Mask> {
        let exec = Registers::exec(self.wave);
        let of = |operand: &str| match operand {
            "-1" => Some(Mask { own: ALL, around: Rc::new(BTreeSet::from([ALL])) }),
            operand => held.get(&Registers::parse(operand)?).cloned(),
        };
        let name = instruction.name.as_str();
        let stem = name.strip_suffix("_b64").or(name.strip_suffix("_b32")).unwrap_or(name);
        let operand = |at: usize| of(instruction.operand(at));
        let within: Vec<Option<Mask>> = match stem {
            "s_mov" => return operand(1),
            "s_and_saveexec" if to == exec => vec![operand(1), held.get(&exec).cloned()],
            "s_andn2_saveexec" | "s_and_not1_saveexec" if to == exec => vec![operand(1)],
            _ if name.contains("saveexec") && to != exec => return held.get(&exec).cloned(),
            "s_and" => vec![operand(1), operand(2)],
            "s_andn2" | "s_and_not1" => vec![operand(1)],
            // Threads of a mask except those of one within it.
            "s_xor" => {
                let pair = operand(1).zip(operand(2));
                vec![pair.filter(|(outer, inner)| outer.contains(inner)).map(|(outer, _)| outer)]
            }
            // A comparison holds for active threads only.
            _ if name.starts_with("v_cmp") => vec![held.get(&exec).cloned()],
            _ => Vec::new(),
        };
        let around: BTreeSet<Name> =
            within.into_iter().flatten().flat_map(|mask| (*mask.around).clone()).collect();
        match around.is_empty() {
            true => None,
            false => Some(Mask::named(block, index, to, around)),
        }
    }
}
