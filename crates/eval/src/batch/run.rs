//! The interpreter's loop for many lanes.

use super::super::code::Instruction;
use super::super::machine::{Env, jump_target};
use super::compute::compute;
use super::image;
use super::rows::{ALL, LANES, LaneRows, Mask, Row, kept_lanes, lanes_of};
use super::schedule::{LaneGroup, Lanes};

/// The first slot of the function's result, and where the results of lanes are kept.
type Results<'r> = (u32, &'r mut [Row]);

/// Runs all lanes until they have ended. `None` if one of them fails.
pub fn run_lanes(
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
    /// It has ended.
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
                    let pc = self.lanes.pc;
                    self.lanes.leave(&group, began);
                    self.lanes.pc = pc;
                }
                After::Waits => {
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
            Instruction::Derivative { .. } if !self.env.quad => return None,
            Instruction::Derivative { .. } => return self.meet(instruction, group),
            Instruction::Image { access } => {
                if self.env.quad && self.env.program.access(access)?.implicit() {
                    return self.meet(instruction, group);
                }
                image::run_single(self.env, access, &mut self.rows(group), at)?;
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
                    .for_each(|i| image::derivative(self.memory, mask, axis, coarse, part(i)));
                Some(())
            }
            Instruction::Image { access } => image::run_quads(self.env, access, self.memory, mask),
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
