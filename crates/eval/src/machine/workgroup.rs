//! Runs compute entry points.
//!
//! Workgroups run one after another. In each of them, every invocation in the order of its index
//! runs until the next barrier, then all go on. An invocation that waits keeps its memory in a lane
//! of its own. What all invocations share is copied from lane to lane.

use super::{
    Lane, Machine, barrier_span, begin_lane, callable_function, place_arguments, slot_from_word,
    waiting_position, word_from_slot,
};
use crate::error::Error;
use crate::layout::{MAX_SLOTS, encode_buffer};
use crate::number::Number;
use crate::program::{Function, FunctionId, GlobalRole};
use lamplight_diagnostic::codes;
use naga::{Binding, BuiltIn};
use std::ops::Range;

/// The most scalars that all waiting invocations of a workgroup may hold.
const MAX_HELD: u64 = 32 * MAX_SLOTS as u64;

/// One invocation: where it is in the grid.
struct Invocation {
    groups: [u32; 3],
    size: [u32; 3],
    group: [u32; 3],
    index: u32,
}

/// A compute entry point that runs.
struct ComputeCall<'p> {
    function: &'p Function,
    groups: [u32; 3],
    size: [u32; 3],
    /// The slots that all invocations share.
    shared: Vec<Range<usize>>,
}

impl<N: Number> Machine<'_, N> {
    /// Runs a compute entry point for a grid of workgroups. [`Self::buffer`] gives the contents of
    /// buffers afterwards. All invocations together count as one call, but for the iterations of
    /// loops, which each invocation counts by itself.
    ///
    /// # Errors
    /// Those of [`Self::call`]; `eval-barrier` where not all invocations reach the same barrier;
    /// `eval-unsupported` for a built-in value that is not computed here, such as those of subgroups.
    pub fn dispatch(&mut self, id: FunctionId, groups: [u32; 3]) -> Result<(), Error> {
        let program = self.program;
        let given = program.signature(id).map_or(0, |function| function.arguments.len());
        let function = callable_function(program, id, given)?;
        let Some(size) = function.workgroup else {
            let message = format!("`{}` is no compute entry point", function.name);
            return Err(Error::new(codes::EVAL_ARGUMENTS, message));
        };
        self.check_buffers(function)?;
        check_inputs(function, &Invocation { groups, size, group: [0; 3], index: 0 })?;
        let call = ComputeCall { function, groups, size, shared: self.shared_slots() };
        self.lane.steps = 0;
        let [x, y, z] = groups;
        for group in (0..z).flat_map(|z| (0..y).flat_map(move |y| (0..x).map(move |x| [x, y, z]))) {
            self.run_group(&call, group)?;
        }
        Ok(())
    }

    /// The bytes of a buffer after the last call. `None` if none is bound there.
    pub fn buffer(&self, group: u32, binding: u32) -> Option<Vec<u8>> {
        let mut bytes = self.resources.buffers.get(&(group, binding))?.clone();
        let is_it = |bound: &bool| *bound;
        let globals = self.program.globals.iter().zip(&self.bound);
        let mut here =
            globals.filter(|(one, bound)| one.binding == Some((group, binding)) && is_it(bound));
        let (global, _) = here.next()?;
        let first = match global.role {
            GlobalRole::Buffer => global.slot,
            GlobalRole::Runtime { address, .. } => self.lane.word(address),
            _ => return None,
        };
        let mut slots = self.lane.memory.get(first as usize..)?.iter();
        encode_buffer(&self.program.types, global.ty, &mut bytes, &mut |kind| {
            slots.next().map_or(0, |slot| word_from_slot(kind, *slot))
        });
        Some(bytes)
    }

    /// Buffers and variables of the workgroup.
    fn shared_slots(&self) -> Vec<Range<usize>> {
        let is_buffer = |role: GlobalRole| role == GlobalRole::Buffer;
        let buffers = self.program.globals.iter().filter(|global| is_buffer(global.role));
        let range = |slot: u32, n: u32| slot as usize..(slot + n) as usize;
        let mut shared: Vec<_> = buffers.map(|global| range(global.slot, global.slots)).collect();
        shared.extend(self.program.workgroup_slots());
        // Buffers of runtime size are behind everything else.
        shared.push(self.program.slots as usize..self.lane.memory.len());
        shared
    }

    fn run_group(&mut self, call: &ComputeCall<'_>, group: [u32; 3]) -> Result<(), Error> {
        for slots in self.program.workgroup_slots() {
            self.lane.memory[slots].fill(N::default());
        }
        let count = call.size.iter().fold(1u32, |all, size| all.saturating_mul(*size));
        let (mut waiting, mut ended) = (Vec::new(), 0);
        for index in 0..count {
            let ComputeCall { function, groups, size, shared: _ } = *call;
            self.begin(function, &Invocation { groups, size, group, index });
            match self.advance()? {
                true => ended += 1,
                false => {
                    let held = (waiting.len() as u64 + 1) * self.lane.memory.len() as u64;
                    if held > MAX_HELD {
                        return Err(Error::too_large(
                            "the invocations of a workgroup hold too much",
                        ));
                    }
                    waiting.push(self.lane.clone());
                }
            }
        }
        while !waiting.is_empty() {
            self.check_barrier(&waiting, ended)?;
            let mut still = Vec::with_capacity(waiting.len());
            for lane in waiting {
                match self.go_on(lane, &call.shared)? {
                    Some(lane) => still.push(lane),
                    None => ended += 1,
                }
            }
            waiting = still;
        }
        Ok(())
    }

    /// Makes an invocation ready to run on the single lane.
    fn begin(&mut self, function: &Function, at: &Invocation) {
        begin_lane(self.program, &mut self.lane, false);
        let words = argument_words(&function.inputs, at);
        let arguments: Vec<N> = function
            .arguments
            .iter()
            .zip(words)
            .map(|(kind, word)| slot_from_word::<N>(*kind, word))
            .collect();
        place_arguments(&mut self.lane, function, &arguments);
        (self.lane.pc, self.lane.trips, self.lane.killed) = (function.entry, 0, false);
        self.lane.calls.clear();
    }

    /// Runs an invocation on from its barrier. Gives its lane back if it has passed another one.
    fn go_on(
        &mut self,
        mut lane: Lane<N>,
        shared: &[Range<usize>],
    ) -> Result<Option<Lane<N>>, Error> {
        std::mem::swap(&mut self.lane, &mut lane);
        copy_shared(&lane, &mut self.lane, shared);
        if self.advance()? {
            return Ok(None);
        }
        std::mem::swap(&mut self.lane, &mut lane);
        copy_shared(&lane, &mut self.lane, shared);
        Ok(Some(lane))
    }

    /// Fails unless all invocations wait at one barrier.
    fn check_barrier(&self, waiting: &[Lane<N>], ended: u32) -> Result<(), Error> {
        let Some(first) = waiting.first() else { return Ok(()) };
        let is_here = |lane: &&Lane<N>| waiting_position(*lane).eq(waiting_position(first));
        let here = waiting.iter().filter(is_here).count();
        if ended == 0 && here == waiting.len() {
            return Ok(());
        }
        let all = waiting.len() + ended as usize;
        let message = format!("{here} of {all} invocations reach this barrier");
        Err(Error::new(codes::EVAL_BARRIER, message).or_at(barrier_span(self.program, first.pc)))
    }
}

/// Copies what all invocations share, and the steps so far.
fn copy_shared<N: Number>(from: &Lane<N>, to: &mut Lane<N>, shared: &[Range<usize>]) {
    for slots in shared {
        to.memory[slots.clone()].copy_from_slice(&from.memory[slots.clone()]);
    }
    to.steps = from.steps;
}

/// Refuses inputs that have no value here.
fn check_inputs(function: &Function, at: &Invocation) -> Result<(), Error> {
    match function.inputs.iter().find(|input| at.value(input).is_none()) {
        None => Ok(()),
        Some(other) => Err(Error::unsupported(format!("the input {other:?}"))),
    }
}

/// The word of each argument slot.
fn argument_words(inputs: &[Option<Binding>], at: &Invocation) -> Vec<u32> {
    let mut words = Vec::with_capacity(inputs.len());
    for (index, input) in inputs.iter().enumerate() {
        let before = inputs[..index].iter().filter(|other| *other == input).count();
        let value = at.value(input).and_then(|value| value.get(before).copied());
        words.push(value.unwrap_or(0));
    }
    words
}

impl Invocation {
    /// What an input holds; `None` for what is not computed here.
    fn value(&self, input: &Option<Binding>) -> Option<[u32; 3]> {
        let Some(Binding::BuiltIn(built_in)) = input else { return None };
        let local = self.local();
        let three = |component: &dyn Fn(usize) -> u32| [0, 1, 2].map(component);
        Some(match built_in {
            BuiltIn::GlobalInvocationId => {
                three(&|i| self.group[i].wrapping_mul(self.size[i]).wrapping_add(local[i]))
            }
            BuiltIn::LocalInvocationId => local,
            BuiltIn::LocalInvocationIndex => [self.index, 0, 0],
            BuiltIn::WorkGroupId => self.group,
            BuiltIn::WorkGroupSize => self.size,
            BuiltIn::NumWorkGroups => self.groups,
            _ => return None,
        })
    }

    fn local(&self) -> [u32; 3] {
        let [x, y, _] = self.size.map(|size| size.max(1));
        [self.index % x, self.index / x % y, self.index / x / y]
    }
}
