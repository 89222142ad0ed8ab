//! Which lanes run next: those with the greatest call depth, and of these the ones with the lowest
//! program counter. So lanes that diverged meet again.

use super::rows::{ALL, LANES, Mask, lanes_of};
use lamplight_files::limits::EVAL_STEPS;

/// The control flow state of all lanes.
#[derive(Debug, Default)]
pub struct Lanes {
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
pub struct LaneGroup {
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
        let waiting = || lanes_of(self.waiting & 0xf << (4 * quad));
        let first = waiting().min_by(|a, b| self.position(*a).cmp(self.position(*b)))?;
        let with = waiting().filter(|lane| self.position(*lane).eq(self.position(first)));
        Some((self.pc[first], with.fold(0, |mask, lane| mask | 1 << lane)))
    }
}
