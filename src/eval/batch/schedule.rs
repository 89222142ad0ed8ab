//! Which lanes run next. Lanes that are apart meet again, since those run first that are deepest in
//! calls, and of them those that are furthest behind in the code.

use super::rows::{ALL, LANES, Mask, lanes_of};
use crate::limits::EVAL_STEPS;

/// Where all lanes are.
#[derive(Debug, Default)]
pub struct Lanes {
    pub pc: [u32; LANES],
    depth: [u32; LANES],
    /// What calls return to, for each depth.
    returns: Vec<[u32; LANES]>,
    steps: [u64; LANES],
    trips: [u64; LANES],
    /// Lanes that can go on.
    pub runnable: Mask,
    /// Lanes that wait for the other lanes of their quads.
    pub waiting: Mask,
    pub killed: Mask,
}

/// Lanes that are at the same place.
#[derive(Debug, Clone, Copy)]
pub struct Group {
    pub mask: Mask,
    pub pc: u32,
    pub depth: u32,
    /// Where other lanes are that are as deep in calls, and further ahead.
    pub next: u32,
    /// Whether no other lane has anything left to do.
    pub alone: bool,
    /// Steps and trips of loops that are left to the lane that has made most of them.
    pub steps_left: u64,
    pub trips_left: u64,
}

impl Lanes {
    pub fn begin(&mut self, entry: u32, running: Mask) {
        let returns = std::mem::take(&mut self.returns);
        *self = Self { pc: [entry; LANES], runnable: running, returns, ..Self::default() };
    }

    /// The lanes that run next.
    pub fn next_group(&self, loop_limit: u64) -> Option<Group> {
        let deepest = lanes_of(self.runnable).map(|lane| self.depth[lane]).max()?;
        let as_deep = || lanes_of(self.runnable).filter(|lane| self.depth[*lane] == deepest);
        let pc = as_deep().map(|lane| self.pc[lane]).min()?;
        let here = |lane: &usize| self.pc[*lane] == pc;
        let mask = as_deep().filter(here).fold(0, |mask, lane| mask | 1 << lane);
        let ahead = as_deep().filter(|lane| !here(lane)).map(|lane| self.pc[lane]).min();
        let most = |counts: &[u64; LANES]| lanes_of(mask).map(|lane| counts[lane]).max();
        Some(Group {
            mask,
            pc,
            depth: deepest,
            next: ahead.unwrap_or(u32::MAX),
            alone: (self.runnable | self.waiting) & !mask == 0,
            steps_left: EVAL_STEPS.saturating_sub(most(&self.steps)?),
            trips_left: loop_limit.saturating_sub(most(&self.trips)?),
        })
    }

    /// Keeps where a group has come to, with what it had left when it was chosen.
    pub fn leave(&mut self, group: &Group, began: (u64, u64)) {
        let (steps, trips) = (began.0 - group.steps_left, began.1 - group.trips_left);
        for lane in lanes_of(group.mask) {
            self.pc[lane] = group.pc;
            self.depth[lane] = group.depth;
            self.steps[lane] += steps;
            self.trips[lane] += trips;
        }
    }

    /// Notes what a call of a group returns to.
    pub fn enter(&mut self, group: &Group, to: u32) {
        let depth = group.depth as usize;
        if self.returns.len() <= depth {
            self.returns.resize(depth + 1, [0; LANES]);
        }
        if group.alone || group.mask == ALL {
            self.returns[depth] = [to; LANES];
        } else {
            lanes_of(group.mask).for_each(|lane| self.returns[depth][lane] = to);
        }
    }

    /// What a lane returns to from a depth.
    pub fn return_of(&self, lane: usize, depth: u32) -> u32 {
        self.returns.get(depth as usize).map_or(0, |row| row[lane])
    }

    /// Where a lane waits: the calls that it is in, and the instruction.
    fn position(&self, lane: usize) -> impl Iterator<Item = u32> + '_ {
        let calls = self.returns.iter().take(self.depth[lane] as usize);
        calls.map(move |row| row[lane]).chain([self.pc[lane]])
    }

    /// Of a quad whose lanes all wait or have ended, those lanes that are furthest behind, since
    /// the others may wait at a place that those still reach.
    pub fn furthest_behind(&self, quad: usize) -> Option<(u32, Mask)> {
        let waiting = || lanes_of(self.waiting & 0xf << (4 * quad));
        let first = waiting().min_by(|a, b| self.position(*a).cmp(self.position(*b)))?;
        let with = waiting().filter(|lane| self.position(*lane).eq(self.position(first)));
        Some((self.pc[first], with.fold(0, |mask, lane| mask | 1 << lane)))
    }
}
