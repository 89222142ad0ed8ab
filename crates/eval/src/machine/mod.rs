//! The memory of a program, and calls of its functions.

mod compute;
mod filter;
mod geometry;
mod lane;
mod packing;
mod quad;
mod quick;
mod texture;
mod watch;
mod word;

use super::error::{Error, Finding};
use super::layout::{SlotKind, decode_buffer};
use super::number::Number;
use super::program::{Function, FunctionId, GlobalRole, InitialValue, Program};
use super::resources::{BoundTextures, Resources};
pub(crate) use compute::convert_slot;
pub(crate) use geometry::geometry;
use lamplight_diagnostic::codes;
pub(crate) use lane::{Env, jump_target};
use lane::{Lane, LaneStop};
pub(crate) use packing::pack;
pub(crate) use quad::derivative_lanes;
pub(crate) use texture::{Slots, apply_access, coordinate_of, gradient_of};
pub(crate) use watch::Watch;
pub(crate) use word::{extract_bits, insert_bits, word1, word2};

/// How many loop iterations one call may make unless set otherwise, all loops together.
pub const LOOP_LIMIT: u64 = lamplight_files::limits::LOOP_TRIPS;

/// A program with its memory. All calls use the same memory, so [`Self::call`] need not allocate.
#[derive(Debug)]
pub struct Machine<'p, N> {
    program: &'p Program,
    resources: Resources,
    /// Textures and samplers by the index of their variable.
    resolved: BoundTextures,
    lane: Lane<N>,
    /// The lanes of a quad, once one has run, and which of them were discarded.
    quad: Vec<Lane<N>>,
    killed: [bool; 4],
    watch: Watch,
    /// The arguments of `call_words`, kept so that the next call need not allocate.
    words: Vec<N>,
    /// Which globals have a buffer that is large enough.
    bound: Vec<bool>,
    /// How many loop iterations one call may make, all loops together.
    pub loop_limit: u64,
}

impl<'p, N: Number> Machine<'p, N> {
    /// Memory for the program, with constants computed and nothing bound.
    ///
    /// # Errors
    /// The error of a constant that cannot be computed.
    pub fn new(program: &'p Program) -> Result<Self, Error> {
        let mut lane =
            Lane { memory: vec![N::default(); program.slots as usize], ..Lane::default() };
        for &(slot, value) in &program.pool {
            lane.memory[slot as usize] = match value {
                InitialValue::Word(word) => N::from_word(word),
                InitialValue::Float(value) => N::from_f64(value),
            };
        }
        let watch = Watch::new(program);
        let mut machine = Self {
            program,
            resources: Resources::default(),
            resolved: BoundTextures::default(),
            lane,
            quad: Vec::new(),
            killed: [false; 4],
            watch,
            words: Vec::new(),
            bound: vec![false; program.globals.len()],
            loop_limit: LOOP_LIMIT,
        };
        machine.run(program.start)?;
        Ok(machine)
    }

    /// The program that this machine runs.
    pub fn program(&self) -> &'p Program {
        self.program
    }

    /// Binds buffers, textures and samplers by group and binding. Using one that is not bound is an
    /// error.
    ///
    /// # Errors
    /// `eval-too-large` for a buffer that is too large.
    pub fn bind(&mut self, resources: Resources) -> Result<(), Error> {
        self.lane.memory.truncate(self.program.slots as usize);
        for (index, global) in self.program.globals.iter().enumerate() {
            self.bound[index] = false;
            let Some(bytes) = global.binding.and_then(|binding| resources.buffers.get(&binding))
            else {
                continue;
            };
            self.bound[index] = bytes.len() >= global.bytes as usize;
            let mut slots = Vec::new();
            decode_buffer(&self.program.types, global.ty, bytes, &mut |kind, word| {
                slots.push(slot_from_word::<N>(kind, word))
            });
            match global.role {
                GlobalRole::Buffer => {
                    let first = global.slot as usize;
                    self.lane.memory[first..first + slots.len()].copy_from_slice(&slots);
                }
                GlobalRole::Runtime { address, count, element } => {
                    self.append(slots, global.slots, address, count, element)?
                }
                _ => {}
            }
        }
        self.quad.clear();
        let places = self.program.globals.iter().map(|global| global.binding);
        self.resolved = BoundTextures::of(&resources, places);
        self.resources = resources;
        Ok(())
    }

    /// Refuses a function whose buffers are not all bound.
    fn check_buffers(&self, function: &Function) -> Result<(), Error> {
        match function.buffers.iter().find(|index| !self.bound[**index as usize]) {
            None => Ok(()),
            Some(index) => {
                let name = &self.program.globals[*index as usize].name;
                Err(Error::new(
                    codes::EVAL_UNBOUND,
                    format!("no buffer of its size is given for `{name}`"),
                ))
            }
        }
    }

    /// Appends a buffer that ends in a runtime-sized array to the memory.
    fn append(
        &mut self,
        slots: Vec<N>,
        least: u32,
        address: u32,
        count: u32,
        element: u32,
    ) -> Result<(), Error> {
        let first = self.lane.memory.len();
        if first + slots.len() > super::layout::MAX_SLOTS as usize {
            return Err(Error::too_large("a buffer is too large for the CPU executor"));
        }
        // `least` is the size with one element, so `least - element` is the part before the array.
        let fixed = (least - element) as usize;
        let elements = slots.len().saturating_sub(fixed) / element.max(1) as usize;
        self.lane.memory.extend(slots);
        self.lane.memory[address as usize] = N::from_word(first as u32);
        self.lane.memory[count as usize] = N::from_word(elements as u32);
        Ok(())
    }

    /// Runs a function on flattened arguments and gives its flattened result. Floats are numbers,
    /// integers and booleans are words ([`Number::from_word`]).
    ///
    /// # Errors
    /// `eval-arguments`, `eval-loop-limit`, `eval-needs-quad`, `eval-unbound`, or why the
    /// function could not be lowered.
    pub fn call(&mut self, id: FunctionId, arguments: &[N]) -> Result<&[N], Error> {
        N::run_call(self, id, arguments)?;
        Ok(self.result(id))
    }

    /// [`Self::call`] without its result.
    pub(crate) fn run_call(&mut self, id: FunctionId, arguments: &[N]) -> Result<(), Error> {
        let program = self.program;
        let function = callable_function(program, id, arguments.len())?;
        self.check_buffers(function)?;
        begin_lane(program, &mut self.lane);
        place_arguments(&mut self.lane, function, arguments);
        self.run(function.entry)
    }

    /// As [`Self::call`], with every scalar as its 32 bits.
    ///
    /// # Errors
    /// Those of [`Self::call`].
    pub fn call_words(
        &mut self,
        id: FunctionId,
        arguments: &[u32],
        result: &mut Vec<u32>,
    ) -> Result<(), Error> {
        let function = callable_function(self.program, id, arguments.len())?;
        self.words.clear();
        self.words.extend(
            function
                .arguments
                .iter()
                .zip(arguments)
                .map(|(kind, word)| slot_from_word::<N>(*kind, *word)),
        );
        self.check_buffers(function)?;
        begin_lane(self.program, &mut self.lane);
        place_arguments(&mut self.lane, function, &self.words);
        self.run(function.entry)?;
        result.clear();
        result.extend(
            function
                .result
                .iter()
                .zip(result_slots(&self.lane, function))
                .map(|(kind, slot)| word_from_slot(*kind, *slot)),
        );
        Ok(())
    }

    /// Runs code on the single lane until it ends.
    fn run(&mut self, entry: u32) -> Result<(), Error> {
        (self.lane.pc, self.lane.trips, self.lane.killed) = (entry, 0, false);
        self.lane.steps = 0;
        self.lane.calls.clear();
        let env = Env {
            program: self.program,
            bound: &self.resolved,
            loop_limit: self.loop_limit,
            quad: false,
        };
        match lane::run_lane(env, &mut self.lane, &mut self.watch)? {
            LaneStop::Done => Ok(()),
            LaneStop::Quad => Err(needs_quad(self.program, self.lane.pc)),
        }
    }

    /// The memory of the single lane, which has all constants and buffers.
    pub(super) fn memory(&self) -> &[N] {
        &self.lane.memory
    }

    /// The function, if it can be run on the arguments of all lanes.
    pub(super) fn runnable(&self, id: FunctionId, lanes: &[&[N]]) -> Option<&'p Function> {
        let function = self.program.signature(id)?;
        let are_fit = lanes.iter().all(|lane| lane.len() == function.arguments.len());
        let is_ready = function.error.is_none() && self.check_buffers(function).is_ok();
        (are_fit && is_ready).then_some(function)
    }

    /// What all lanes share.
    pub(super) fn env(&self, quad: bool) -> Env<'_> {
        Env { program: self.program, bound: &self.resolved, loop_limit: self.loop_limit, quad }
    }

    /// Whether the last call ran into `discard`.
    pub fn discarded(&self) -> bool {
        self.lane.killed
    }

    /// Steps of the last call. Long copies count as more than one.
    pub fn steps(&self) -> u64 {
        self.lane.steps
    }

    /// The flattened result of the last call, which must have been a call of this function.
    pub fn result(&self, id: FunctionId) -> &[N] {
        let function = self.program.signature(id);
        function.map_or(&[], |function| result_slots(&self.lane, function))
    }

    /// Loop iterations of the last call.
    pub fn trips(&self) -> u64 {
        self.lane.trips
    }

    /// Turns the recording of numeric trouble on or off. Ambiguous comparisons are always
    /// recorded.
    pub fn sanitize(&mut self, on: bool) {
        self.watch.sanitize = on;
    }

    /// What was reported since the last [`Self::forget`], by kind and place.
    pub fn findings(&self) -> Vec<Finding> {
        self.watch.findings(self.program)
    }

    /// How often each of [`Program::points`] was reached since the last [`Self::forget`].
    pub fn hits(&self) -> &[u64] {
        &self.watch.hits
    }

    /// Forgets findings and hits.
    pub fn forget(&mut self) {
        self.watch.forget();
    }
}

fn callable_function(program: &Program, id: FunctionId, given: usize) -> Result<&Function, Error> {
    let function = program
        .signature(id)
        .ok_or_else(|| Error::new(codes::EVAL_ARGUMENTS, "no such function in this program"))?;
    if let Some(error) = &function.error {
        return Err(error.clone());
    }
    let (name, wanted) = (&function.name, function.arguments.len());
    if given != wanted {
        return Err(Error::new(
            codes::EVAL_ARGUMENTS,
            format!("`{name}` takes {wanted} scalars and was given {given}"),
        ));
    }
    Ok(function)
}

/// Sets private variables to their initial values.
fn begin_lane<N: Number>(program: &Program, lane: &mut Lane<N>) {
    for (slots, from) in program.privates() {
        match from {
            Some(from) => lane.memory.copy_within(from, slots.start),
            None => lane.memory[slots].fill(N::default()),
        }
    }
}

fn place_arguments<N: Number>(lane: &mut Lane<N>, function: &Function, arguments: &[N]) {
    let mut rest = arguments;
    for parameter in &function.parameters {
        let (value, others) = rest.split_at(parameter.n as usize);
        let to = parameter.pointee.unwrap_or(parameter.slot) as usize;
        lane.memory[to..to + value.len()].copy_from_slice(value);
        if let Some(pointee) = parameter.pointee {
            lane.memory[parameter.slot as usize] = N::from_word(pointee);
        }
        rest = others;
    }
}

fn result_slots<'l, N>(lane: &'l Lane<N>, function: &Function) -> &'l [N] {
    let first = function.result_slot as usize;
    &lane.memory[first..first + function.result.len()]
}

fn needs_quad(program: &Program, pc: u32) -> Error {
    let span = program.spans.get(pc as usize).copied().unwrap_or_default();
    Error::new(codes::EVAL_NEEDS_QUAD, "a derivative needs a quad of four fragments").or_at(span)
}

/// A slot from the 32 bits of a scalar.
pub(super) fn slot_from_word<N: Number>(kind: SlotKind, word: u32) -> N {
    match kind {
        SlotKind::Float => N::from_f64(f64::from(f32::from_bits(word))),
        _ => N::from_word(word),
    }
}

fn word_from_slot<N: Number>(kind: SlotKind, slot: N) -> u32 {
    match kind {
        SlotKind::Float => slot.bits(),
        _ => slot.word(),
    }
}
