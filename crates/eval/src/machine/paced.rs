//! A run that its caller moves on piece by piece, and of which copies can be kept.
//!
//! A copy goes on as the run would, so whoever keeps some can go back without running all again.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::observe::{Executed, Observer, action_of};
use super::watch::Watch;
use super::{
    Action, Env, Lane, LaneStop, Machine, begin_lane, callable_function, first_group, meet,
    needs_quad, needs_workgroup, place_arguments, result_slots, run_lane, step_lane, texture,
};
use crate::error::{Error, FindingKind};
use crate::number::Number;
use crate::program::{FunctionId, Program};
use crate::resources::BoundTextures;

/// An observed run of a function: of one lane that runs alone, or of one in a quad.
#[derive(Debug, Clone)]
pub struct Paced<N> {
    function: FunctionId,
    bound: Arc<BoundTextures>,
    loop_limit: u64,
    state: State<N>,
}

/// What changes while it runs.
#[derive(Debug, Clone)]
struct State<N> {
    lanes: Vec<Lane<N>>,
    /// The lane that is observed.
    shown: usize,
    /// Which lanes wait at an instruction that needs the others, and which have ended.
    stops: [Option<LaneStop>; 4],
    watch: Watch,
    /// What the other lanes report, which is of no interest.
    others: Watch,
    fresh: Vec<FindingKind>,
}

impl<N: Number> Machine<'_, N> {
    /// A call that is observed, before its first instruction.
    ///
    /// # Errors
    /// Those of [`Machine::call`] about the function and its arguments.
    pub fn pace_call(&self, id: FunctionId, arguments: &[N]) -> Result<Paced<N>, Error> {
        self.pace(id, &[arguments], 0)
    }

    /// The four fragments of a quad in the order of [`Machine::quad`], of which one is observed,
    /// before their first instruction. Findings are those of this lane.
    ///
    /// # Errors
    /// Those of [`Machine::call`] about the function and its arguments.
    pub fn pace_quad(
        &self,
        id: FunctionId,
        arguments: [&[N]; 4],
        lane: usize,
    ) -> Result<Paced<N>, Error> {
        self.pace(id, &arguments, lane & 3)
    }

    fn pace(&self, id: FunctionId, all: &[&[N]], shown: usize) -> Result<Paced<N>, Error> {
        let mut lanes = Vec::with_capacity(all.len());
        for arguments in all {
            let function = callable_function(self.program, id, arguments.len())?;
            self.check_buffers(function)?;
            let mut lane = self.lane.clone();
            begin_lane(self.program, &mut lane, true);
            place_arguments(&mut lane, function, arguments);
            lane.start(function.entry);
            lanes.push(lane);
        }
        let mut watch = Watch::new(self.program);
        watch.sanitize = self.watch.sanitize;
        Ok(Paced {
            function: id,
            bound: Arc::clone(&self.resolved),
            loop_limit: self.loop_limit,
            state: State {
                lanes,
                shown,
                stops: [None; 4],
                watch,
                others: Watch::new(self.program),
                fresh: Vec::new(),
            },
        })
    }
}

impl<N: Number> Paced<N> {
    /// Begins again, with other arguments for all lanes.
    ///
    /// # Errors
    /// Those of [`Machine::call`] about the arguments.
    pub fn again(&mut self, program: &Program, arguments: &[N]) -> Result<(), Error> {
        let function = callable_function(program, self.function, arguments.len())?;
        for lane in &mut self.state.lanes {
            begin_lane(program, lane, true);
            place_arguments(lane, function, arguments);
            lane.start(function.entry);
        }
        self.state.stops = [None; 4];
        Ok(())
    }

    /// A run of a quad with other arguments, of which another lane may be observed. The run itself
    /// must not have begun.
    ///
    /// # Errors
    /// Those of [`Machine::call`] about the arguments.
    pub fn with_quad(
        &self,
        program: &Program,
        arguments: [&[N]; 4],
        lane: usize,
    ) -> Result<Self, Error> {
        let mut other = self.clone();
        for (lane, arguments) in other.state.lanes.iter_mut().zip(arguments) {
            let function = callable_function(program, self.function, arguments.len())?;
            place_arguments(lane, function, arguments);
        }
        other.state.shown = lane & 3;
        Ok(other)
    }

    fn lane(&self) -> Option<&Lane<N>> {
        self.state.lanes.get(self.state.shown)
    }

    /// Whether the observed lane has returned.
    pub fn has_ended(&self) -> bool {
        self.state.stops[self.state.shown] == Some(LaneStop::Done)
    }

    /// The memory of the observed lane.
    pub fn memory(&self) -> &[N] {
        self.lane().map_or(&[], |lane| &lane.memory)
    }

    /// Gives the variables of the module, and buffers, the values that variables of these names have in
    /// the memory of a run of another program.
    pub fn take_module(&mut self, program: &Program, other: &Program, memory: &[N]) {
        let from: BTreeMap<_, _> = other.module_slots(memory).into_iter().collect();
        for lane in &mut self.state.lanes {
            for (name, slots) in program.module_slots(&lane.memory) {
                let given = from.get(name).and_then(|from| memory.get(from.clone()));
                let own = lane.memory.get_mut(slots);
                for (own, given) in own.into_iter().flatten().zip(given.into_iter().flatten()) {
                    *own = *given;
                }
            }
        }
    }

    /// The flattened result of the observed lane, once it has returned.
    pub fn result(&self, program: &Program) -> Vec<N> {
        let both = program.signature(self.function).zip(self.lane());
        both.map_or(Vec::new(), |(function, lane)| result_slots(lane, function).to_vec())
    }

    /// Whether the observed lane ran into `discard`.
    pub fn is_discarded(&self) -> bool {
        self.lane().is_some_and(|lane| lane.killed)
    }

    /// How many steps and turns of loops the observed lane has made.
    pub fn made(&self) -> (u64, u64) {
        self.lane().map_or((0, 0), |lane| (lane.steps, lane.trips))
    }

    /// About how many bytes a copy needs.
    pub fn bytes(&self) -> usize {
        let slots: usize = self.state.lanes.iter().map(|lane| lane.memory.len()).sum();
        slots * size_of::<N>() + 2 * size_of::<u64>() * self.state.watch.hits.len()
    }

    /// Shows the observer the next instruction before it runs.
    ///
    /// # Errors
    /// The observer's.
    pub fn look(&mut self, program: &Program, observer: &mut dyn Observer<N>) -> Result<(), Error> {
        let Self { function: _, bound, loop_limit, state } = self;
        let quad = state.lanes.len() > 1;
        let env = Env { program, bound, loop_limit: *loop_limit, quad };
        let Some(lane) = state.lanes.get_mut(state.shown) else { return Ok(()) };
        let (pc, depth) = (lane.pc, lane.calls.len());
        let (action, span) = (action_of(env, lane, pc), env.span(pc));
        let memory = &mut lane.memory[..];
        let (found, gradient) = (&[][..], None);
        observer.ahead(&mut Executed { pc, span, action, depth, found, memory, env, gradient })
    }

    /// Runs the next instruction and shows it.
    ///
    /// # Errors
    /// Those of [`Machine::call`] and the observer's.
    pub fn step(&mut self, program: &Program, observer: &mut dyn Observer<N>) -> Result<(), Error> {
        let Self { function: _, bound, loop_limit, state } = self;
        let quad = state.lanes.len() > 1;
        let env = Env { program, bound, loop_limit: *loop_limit, quad };
        let Some(lane) = state.lanes.get_mut(state.shown) else { return Ok(()) };
        let pc = lane.pc;
        let stop = step_lane(env, lane, &mut state.watch)?;
        state.stops[state.shown] = stop;
        let gradient = match stop {
            Some(LaneStop::Barrier) => return Err(needs_workgroup(program, lane.pc)),
            Some(LaneStop::Quad) if !quad => return Err(needs_quad(program, lane.pc)),
            Some(LaneStop::Quad) => state.meet_others(env)?,
            Some(LaneStop::Done) | None => None,
        };
        state.show(env, pc, gradient, observer)
    }

    /// Runs all of it.
    ///
    /// # Errors
    /// Those of [`Self::step`].
    pub fn finish(
        &mut self,
        program: &Program,
        observer: &mut dyn Observer<N>,
    ) -> Result<(), Error> {
        while !self.has_ended() {
            self.look(program, observer)?;
            self.step(program, observer)?;
        }
        Ok(())
    }
}

impl<N: Number> State<N> {
    /// Runs the other lanes until the observed one has what it waits for.
    fn meet_others(&mut self, env: Env<'_>) -> Result<Option<texture::Gradient>, Error> {
        loop {
            for (index, lane) in self.lanes.iter_mut().enumerate() {
                if self.stops[index].is_none() {
                    let stop = run_lane(env, lane, &mut self.others)?;
                    if stop == LaneStop::Barrier {
                        return Err(needs_workgroup(env.program, lane.pc));
                    }
                    self.stops[index] = Some(stop);
                }
            }
            let is_waiting = |index: &usize| self.stops[*index] == Some(LaneStop::Quad);
            let waiting: Vec<usize> = (0..self.lanes.len()).filter(is_waiting).collect();
            let group = first_group(&self.lanes, &waiting);
            let Some(&first) = group.first() else { return Ok(None) };
            let (at, is_own) = (self.lanes[first].pc, group.contains(&self.shown));
            let watch = if is_own { &mut self.watch } else { &mut self.others };
            let gradients = meet(env, &mut self.lanes, &group, at, watch)?;
            group.iter().for_each(|index| self.stops[*index] = None);
            if is_own {
                return Ok(gradients[self.shown]);
            }
        }
    }

    fn show(
        &mut self,
        env: Env<'_>,
        pc: u32,
        gradient: Option<texture::Gradient>,
        observer: &mut dyn Observer<N>,
    ) -> Result<(), Error> {
        let Some(lane) = self.lanes.get_mut(self.shown) else { return Ok(()) };
        let action = action_of(env, lane, pc);
        // A call already has its return address, and a return no longer has it.
        let depth = match action {
            Action::Call { .. } => lane.calls.len().saturating_sub(1),
            Action::Return if pc + 1 != lane.pc => lane.calls.len() + 1,
            _ => lane.calls.len(),
        };
        self.watch.take_fresh(&mut self.fresh);
        let (span, found, memory) = (env.span(pc), &self.fresh[..], &mut lane.memory[..]);
        observer.see(&mut Executed { pc, span, action, depth, found, memory, env, gradient })
    }
}
