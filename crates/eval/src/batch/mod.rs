//! Many lanes in lock-step: each instruction is decoded once for all lanes that are at it. Every
//! lane gets the bits that [`Machine::call`] and [`Machine::quad`] would give it. If a lane fails,
//! the machine runs the lanes again one by one, and its error is returned.
//!
//! The schedule chooses which lanes run next: those with the greatest call depth, and of these the
//! ones with the lowest program counter. So lanes that diverged meet again.

mod compute;

use crate::code::Instruction;
use crate::error::Error;
use crate::machine::{Env, Machine, jump_target};
use crate::program::FunctionId;
use compute::{
    ALL, LANES, LaneRows, Mask, Row, compute, derivative, kept_lanes, lanes_of, run_quads,
    run_single,
};
use lamplight_files::limits::EVAL_STEPS;

/// The most slots of a program that runs in lock-step; larger ones run lane by lane.
const MOST_SLOTS: usize = 1 << 18;

/// A machine, and the memory of many lanes besides its own.
#[derive(Debug)]
pub struct Batch<'p> {
    machine: Machine<'p, f32>,
    /// A row for each slot; empty for a program that is too large.
    memory: Vec<Row>,
    lanes: Lanes,
    /// A row for each slot of the result.
    results: Vec<Row>,
}

/// Receives the index of a lane, its flattened result, and whether it was discarded.
type Give<'g> = dyn FnMut(usize, &[f32], bool) + 'g;

impl<'p> Batch<'p> {
    /// How many lanes run together.
    pub const LANES: usize = LANES;

    /// Takes a machine with its constants and all that is bound to it.
    pub fn new(machine: Machine<'p, f32>) -> Self {
        let slots = machine.memory();
        let memory = match slots.len() <= MOST_SLOTS {
            true => slots.iter().map(|value| [*value; LANES]).collect(),
            false => Vec::new(),
        };
        Self { machine, memory, lanes: Lanes::default(), results: Vec::new() }
    }

    /// Runs a function once for each element of `arguments`. The lanes are independent, so
    /// derivatives are not possible.
    ///
    /// # Errors
    /// Those of [`Machine::call`].
    pub fn calls(
        &mut self,
        id: FunctionId,
        arguments: &[&[f32]],
        give: &mut Give<'_>,
    ) -> Result<(), Error> {
        for (index, some) in arguments.chunks(LANES).enumerate() {
            let first = index * LANES;
            if self.run(id, some, false).is_some() {
                self.give_back(first, some.len(), give);
                continue;
            }
            for (lane, arguments) in some.iter().enumerate() {
                self.machine.call(id, arguments)?;
                let is_killed = self.machine.discarded();
                give(first + lane, self.machine.result(id), is_killed);
            }
        }
        Ok(())
    }

    /// Runs a function on the fragments of quads, four after four in the order of
    /// [`Machine::quad`].
    ///
    /// # Errors
    /// Those of [`Machine::quad`].
    pub fn quads(
        &mut self,
        id: FunctionId,
        arguments: &[[&[f32]; 4]],
        give: &mut Give<'_>,
    ) -> Result<(), Error> {
        for (index, quads) in arguments.chunks(LANES / 4).enumerate() {
            let first = index * LANES;
            if self.run(id, quads.as_flattened(), true).is_some() {
                self.give_back(first, 4 * quads.len(), give);
                continue;
            }
            for (place, quad) in quads.iter().enumerate() {
                let results = self.machine.quad(id, *quad)?;
                let killed = self.machine.quad_discarded();
                for (lane, result) in results.iter().enumerate() {
                    give(first + 4 * place + lane, result, killed[lane]);
                }
            }
        }
        Ok(())
    }

    /// Runs up to [`Self::LANES`] lanes. `None` if a lane fails or the program is too large: the
    /// caller then runs the lanes on the machine, which also finds the error.
    fn run(&mut self, id: FunctionId, arguments: &[&[f32]], is_quads: bool) -> Option<()> {
        if self.memory.is_empty() {
            return None;
        }
        let function = self.machine.runnable(id, arguments)?;
        self.begin();
        for (lane, arguments) in arguments.iter().enumerate() {
            let mut rest = arguments.iter();
            for parameter in &function.parameters {
                let to = parameter.pointee.unwrap_or(parameter.slot);
                for (slot, value) in (to..to + parameter.n).zip(&mut rest) {
                    self.memory[slot as usize][lane] = *value;
                }
                if let Some(pointee) = parameter.pointee {
                    self.memory[parameter.slot as usize][lane] = f32::from_bits(pointee);
                }
            }
        }
        let running = if arguments.len() < LANES { (1 << arguments.len()) - 1 } else { ALL };
        self.results.clear();
        self.results.resize(function.result.len(), [0.0; LANES]);
        self.lanes.begin(function.entry, running);
        let env = self.machine.env(is_quads);
        run_lanes(env, &mut self.memory, &mut self.lanes, (function.result_slot, &mut self.results))
    }

    /// Sets private variables to their initial values.
    fn begin(&mut self) {
        for (slots, from) in self.machine.program().initial_values(true) {
            match from {
                Some(from) => self.memory.copy_within(from, slots.start),
                None => self.memory[slots].fill([0.0; LANES]),
            }
        }
    }

    fn give_back(&self, first: usize, count: usize, give: &mut Give<'_>) {
        let mut result = vec![0.0; self.results.len()];
        for lane in 0..count {
            for (value, row) in result.iter_mut().zip(&self.results) {
                *value = row[lane];
            }
            give(first + lane, &result, self.lanes.killed >> lane & 1 != 0);
        }
    }
}

/// The first slot of the function's result, and where the results of lanes are kept.
type Results<'r> = (u32, &'r mut [Row]);

/// Runs all lanes until they have ended. `None` if one of them fails.
fn run_lanes(
    env: Env<'_>,
    memory: &mut [Row],
    lanes: &mut Lanes,
    results: Results<'_>,
) -> Option<()> {
    let mut run = BatchRun { env, memory, lanes, keep: kept_lanes(ALL), results };
    loop {
        if let Some(group) = run.lanes.next_group(env.loop_limit) {
            run.advance(group)?;
        } else if run.lanes.waiting != 0 {
            run.release()?;
        } else {
            return Some(());
        }
    }
}

struct BatchRun<'r> {
    env: Env<'r>,
    memory: &'r mut [Row],
    lanes: &'r mut Lanes,
    /// [`kept_lanes`] of the group that runs.
    keep: [u32; LANES],
    results: Results<'r>,
}

/// What becomes of a group after an instruction.
enum After {
    /// It goes on.
    Next,
    /// Its call depth changed. It goes on only if no other lane is left, since lanes at another
    /// depth may now come first.
    Moved,
    /// Its lanes diverged. Their program counters are already stored.
    Split,
    /// It waits for other lanes of its quads.
    Waits,
    Ended,
}

impl BatchRun<'_> {
    /// Runs a group until it ends, waits or diverges, or until other lanes come first.
    fn advance(&mut self, mut group: LaneGroup) -> Option<()> {
        let began = (group.steps_left, group.trips_left);
        self.keep = kept_lanes(group.mask);
        loop {
            let instruction = self.env.program.instruction(group.pc)?;
            group.steps_left = group.steps_left.checked_sub(instruction.steps())?;
            let at = group.pc;
            group.pc += 1;
            let after = self.step(instruction, &mut group, at)?;
            match after {
                After::Next if group.pc < group.next => continue,
                After::Moved if group.alone => continue,
                After::Next | After::Moved => self.lanes.leave(&group, began),
                After::Split => {
                    // `leave` gives all lanes the group's program counter, but each has its own now.
                    let pc = self.lanes.pc;
                    self.lanes.leave(&group, began);
                    self.lanes.pc = pc;
                }
                After::Waits => {
                    // The instruction runs when the quad is complete, so the lanes stay at it.
                    group.pc = at;
                    self.lanes.leave(&group, began);
                    self.lanes.waiting |= group.mask;
                    self.lanes.runnable &= !group.mask;
                }
                After::Ended => {
                    self.lanes.leave(&group, began);
                    self.lanes.runnable &= !group.mask;
                }
            }
            return Some(());
        }
    }

    #[inline(always)]
    fn step(&mut self, instruction: &Instruction, group: &mut LaneGroup, at: u32) -> Option<After> {
        match *instruction {
            Instruction::Jump { to } => {
                group.pc = to;
                return Some(After::Next);
            }
            Instruction::JumpUnless { condition, to } => {
                return Some(self.branch(condition, to, group));
            }
            Instruction::Mark { .. } => return Some(After::Next),
            Instruction::Trip => {
                group.trips_left = group.trips_left.checked_sub(1)?;
                return Some(After::Next);
            }
            Instruction::Switch { selector, table } => {
                return Some(self.switch(selector, table, group));
            }
            Instruction::Call { to } => {
                self.lanes.enter(group, group.pc);
                group.depth += 1;
                group.pc = to;
                return Some(After::Moved);
            }
            Instruction::Return => return Some(self.give_back(group)),
            Instruction::Kill => self.lanes.killed |= group.mask,
            Instruction::Barrier => return None,
            Instruction::Derivative { .. } if !self.env.quad => return None,
            Instruction::Derivative { .. } => return self.meet(instruction, group),
            Instruction::Image { access } => {
                if self.env.quad && self.env.program.access(access)?.implicit() {
                    return self.meet(instruction, group);
                }
                run_single(self.env, access, &mut self.rows(group), at)?;
            }
            _ => compute(instruction, &mut self.rows(group)),
        }
        Some(After::Next)
    }

    #[inline(always)]
    fn rows(&mut self, group: &LaneGroup) -> LaneRows<'_> {
        LaneRows::new(self.memory, group.mask, group.alone, &self.keep)
    }

    #[inline(always)]
    fn branch(&mut self, condition: u32, to: u32, group: &mut LaneGroup) -> After {
        let held = self.rows(group).truth(condition);
        if held == group.mask {
            return After::Next;
        }
        if held == 0 {
            group.pc = to;
            return After::Next;
        }
        for lane in lanes_of(group.mask) {
            self.lanes.pc[lane] = if held >> lane & 1 != 0 { group.pc } else { to };
        }
        After::Split
    }

    fn switch(&mut self, selector: u32, table: u32, group: &mut LaneGroup) -> After {
        let rows = self.rows(group);
        if let Some(selector) = rows.common(selector) {
            group.pc = jump_target(self.env.program, table, selector);
            return After::Next;
        }
        let selectors = rows.words(selector);
        for lane in lanes_of(group.mask) {
            self.lanes.pc[lane] = jump_target(self.env.program, table, selectors[lane]);
        }
        After::Split
    }

    /// Returns from a call, or ends the lanes and keeps their results.
    fn give_back(&mut self, group: &mut LaneGroup) -> After {
        let Some(depth) = group.depth.checked_sub(1) else {
            let (first, results) = &mut self.results;
            let from = &self.memory[*first as usize..];
            for (to, row) in results.iter_mut().zip(from) {
                lanes_of(group.mask).for_each(|lane| to[lane] = row[lane]);
            }
            return After::Ended;
        };
        group.depth = depth;
        let to = |lane| self.lanes.return_of(lane, depth);
        let first = lanes_of(group.mask).next().map_or(0, to);
        if lanes_of(group.mask).all(|lane| to(lane) == first) {
            group.pc = first;
            return After::Moved;
        }
        let places: [u32; LANES] = std::array::from_fn(to);
        lanes_of(group.mask).for_each(|lane| self.lanes.pc[lane] = places[lane]);
        After::Split
    }

    /// Runs an instruction that needs values from all lanes of a quad. The group waits if it has
    /// only some lanes of a quad, or if other lanes have not ended.
    fn meet(&mut self, instruction: &Instruction, group: &LaneGroup) -> Option<After> {
        let are_whole = group.alone
            && (0..LANES / 4).all(|quad| matches!(group.mask >> (4 * quad) & 0xf, 0 | 0xf));
        if !are_whole {
            return Some(After::Waits);
        }
        self.together(instruction, group.mask)?;
        Some(After::Next)
    }

    fn together(&mut self, instruction: &Instruction, mask: Mask) -> Option<()> {
        match *instruction {
            Instruction::Derivative { axis, coarse, n, to, a } => {
                let part = |i: u32| (to + i, a.at(i) as u32);
                (0..u32::from(n))
                    .for_each(|i| derivative(self.memory, mask, axis, coarse, part(i)));
                Some(())
            }
            Instruction::Image { access } => run_quads(self.env, access, self.memory, mask),
            _ => Some(()),
        }
    }

    /// Called when no lane can run. In each quad, runs the instruction for those waiting lanes that
    /// are furthest behind, and lets them go on.
    fn release(&mut self) -> Option<()> {
        for quad in 0..LANES / 4 {
            let Some((pc, mask)) = self.lanes.furthest_behind(quad) else { continue };
            let instruction = self.env.program.instruction(pc)?;
            self.together(instruction, mask)?;
            lanes_of(mask).for_each(|lane| self.lanes.pc[lane] += 1);
            self.lanes.waiting &= !mask;
            self.lanes.runnable |= mask;
        }
        Some(())
    }
}

/// The control flow state of all lanes.
#[derive(Debug, Default)]
struct Lanes {
    pub pc: [u32; LANES],
    depth: [u32; LANES],
    /// The return addresses of calls, for each call depth.
    returns: Vec<[u32; LANES]>,
    steps: [u64; LANES],
    trips: [u64; LANES],
    /// Lanes that can go on.
    pub runnable: Mask,
    /// Lanes that wait for the other lanes of their quads.
    pub waiting: Mask,
    pub killed: Mask,
}

/// Lanes with the same program counter and call depth.
#[derive(Debug, Clone, Copy)]
struct LaneGroup {
    pub mask: Mask,
    pub pc: u32,
    pub depth: u32,
    /// The lowest program counter of the other runnable lanes of the same call depth. The group
    /// runs alone only as long as it is below this.
    pub next: u32,
    /// Whether no other lane has anything left to do.
    pub alone: bool,
    /// The steps that are left until the limit, for the lane of the group that has made the most.
    pub steps_left: u64,
    /// The same for loop iterations.
    pub trips_left: u64,
}

impl Lanes {
    pub fn begin(&mut self, entry: u32, running: Mask) {
        let returns = std::mem::take(&mut self.returns);
        *self = Self { pc: [entry; LANES], runnable: running, returns, ..Self::default() };
    }

    /// The lanes that run next. `None` if no lane is runnable.
    pub fn next_group(&self, loop_limit: u64) -> Option<LaneGroup> {
        // Code is laid out so that branches that diverge meet at a higher program counter. So the lanes
        // with the lowest one are behind, and run until they reach the others. That holds within one
        // call only: a called function may have any place in the code, so calls are finished first.
        let deepest = lanes_of(self.runnable).map(|lane| self.depth[lane]).max()?;
        let as_deep = || lanes_of(self.runnable).filter(|lane| self.depth[*lane] == deepest);
        let pc = as_deep().map(|lane| self.pc[lane]).min()?;
        let here = |lane: &usize| self.pc[*lane] == pc;
        let mask = as_deep().filter(here).fold(0, |mask, lane| mask | 1 << lane);
        let ahead = as_deep().filter(|lane| !here(lane)).map(|lane| self.pc[lane]).min();
        let most = |counts: &[u64; LANES]| lanes_of(mask).map(|lane| counts[lane]).max();
        Some(LaneGroup {
            mask,
            pc,
            depth: deepest,
            next: ahead.unwrap_or(u32::MAX),
            alone: (self.runnable | self.waiting) & !mask == 0,
            // Lanes that diverged have made different numbers of steps. The group stops at the limit
            // of the one with the most, so no lane passes a limit that it would hit alone.
            steps_left: EVAL_STEPS.saturating_sub(most(&self.steps)?),
            trips_left: loop_limit.saturating_sub(most(&self.trips)?),
        })
    }

    /// Writes the position of a group back to its lanes, and adds the steps and trips that it made.
    /// `began` is how many of both it had left when it was chosen.
    pub fn leave(&mut self, group: &LaneGroup, began: (u64, u64)) {
        let (steps, trips) = (began.0 - group.steps_left, began.1 - group.trips_left);
        for lane in lanes_of(group.mask) {
            self.pc[lane] = group.pc;
            self.depth[lane] = group.depth;
            self.steps[lane] += steps;
            self.trips[lane] += trips;
        }
    }

    /// Stores the return address of a call that a group makes.
    pub fn enter(&mut self, group: &LaneGroup, to: u32) {
        let depth = group.depth as usize;
        if self.returns.len() <= depth {
            self.returns.resize(depth + 1, [0; LANES]);
        }
        // If no other lane has anything left to do, the whole row is written, which is one store of a
        // vector instead of sixteen.
        if group.alone || group.mask == ALL {
            self.returns[depth] = [to; LANES];
        } else {
            lanes_of(group.mask).for_each(|lane| self.returns[depth][lane] = to);
        }
    }

    /// The return address of the call that a lane made at a call depth.
    pub fn return_of(&self, lane: usize, depth: u32) -> u32 {
        self.returns.get(depth as usize).map_or(0, |row| row[lane])
    }

    /// Where a lane waits: the return addresses of its calls, then its instruction.
    fn position(&self, lane: usize) -> impl Iterator<Item = u32> + '_ {
        let calls = self.returns.iter().take(self.depth[lane] as usize);
        calls.map(move |row| row[lane]).chain([self.pc[lane]])
    }

    /// For a quad whose lanes all wait or have ended: the waiting lanes that are furthest behind,
    /// and their instruction. They go first, since they may still reach the place where the others
    /// wait.
    pub fn furthest_behind(&self, quad: usize) -> Option<(u32, Mask)> {
        // Positions compare like the order of execution: the outermost call decides first.
        let waiting = || lanes_of(self.waiting & 0xf << (4 * quad));
        let first = waiting().min_by(|a, b| self.position(*a).cmp(self.position(*b)))?;
        let with = waiting().filter(|lane| self.position(*lane).eq(self.position(first)));
        Some((self.pc[first], with.fold(0, |mask, lane| mask | 1 << lane)))
    }
}
