//! The memory of a program, and calls of its functions.
//!
//! A lane is one thread of the shader: its memory, its position in the code, and the loop that runs
//! it. A call has one lane. A quad has four, one for each fragment: each runs alone up to a
//! derivative, where it waits for the others. A [`Watch`] collects what a run reports: coverage, and
//! trouble with numbers.
//!
//! What instructions compute is in [`compute`], and what textures give in [`texture`].

mod compute;
mod observe;
mod paced;
mod texture;
mod watch;
mod workgroup;

use crate::code::{Binary, DerivativeDirection, Instruction, Unary};
use crate::error::{Error, Finding, FindingKind};
use crate::layout::{SlotKind, decode_buffer};
use crate::number::Number;
use crate::program::{Function, FunctionId, GlobalRole, InitialValue, Program};
use crate::resources::{BoundTextures, Resources};
use compute::compute;
pub(crate) use compute::{convert_slot, extract_bits, geometry, insert_bits, pack, word1, word2};
use lamplight_diagnostic::codes;
use lamplight_files::limits::EVAL_STEPS;
pub use observe::{Action, Executed, Observer};
pub use paced::Paced;
use std::sync::Arc;
pub(crate) use texture::{Slots, apply_access, coordinate_of, gradient_of};
pub use texture::{TexelRead, TextureRead};
pub(crate) use watch::Watch;

/// How many loop iterations one call may make unless set otherwise, all loops together.
pub const LOOP_LIMIT: u64 = lamplight_files::limits::LOOP_TRIPS;

/// A program with its memory. All calls use the same memory, so [`Self::call`] need not allocate.
#[derive(Debug)]
pub struct Machine<'p, N> {
    program: &'p Program,
    resources: Resources,
    /// Textures and samplers by the index of their variable.
    resolved: Arc<BoundTextures>,
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
            resolved: Arc::default(),
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
        self.resolved = Arc::new(BoundTextures::of(&resources, places));
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
        if first + slots.len() > crate::layout::MAX_SLOTS as usize {
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
        begin_lane(program, &mut self.lane, true);
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
        begin_lane(self.program, &mut self.lane, true);
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
        self.lane.start(entry);
        match self.advance()? {
            true => Ok(()),
            false => Err(needs_workgroup(self.program, self.lane.pc)),
        }
    }

    /// Runs the single lane until it ends (`true`) or has passed a barrier.
    fn advance(&mut self) -> Result<bool, Error> {
        let env = Env {
            program: self.program,
            bound: &self.resolved,
            loop_limit: self.loop_limit,
            quad: false,
        };
        match run_lane(env, &mut self.lane, &mut self.watch)? {
            LaneStop::Done => Ok(true),
            LaneStop::Barrier => Ok(false),
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

/// Sets variables to their initial values: also those of the workgroup, if the lane runs alone.
fn begin_lane<N: Number>(program: &Program, lane: &mut Lane<N>, is_alone: bool) {
    for (slots, from) in program.initial_values(is_alone) {
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

/// The error of a lane that stopped behind a barrier though it runs alone.
fn needs_workgroup(program: &Program, pc: u32) -> Error {
    let message = "a barrier needs the other invocations of a workgroup";
    Error::new(codes::EVAL_BARRIER, message).or_at(barrier_span(program, pc))
}

/// The place of the barrier that a lane has passed.
fn barrier_span(program: &Program, pc: u32) -> naga::Span {
    program.spans.get(pc.saturating_sub(1) as usize).copied().unwrap_or_default()
}

/// A slot from the 32 bits of a scalar.
fn slot_from_word<N: Number>(kind: SlotKind, word: u32) -> N {
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

/// The state of one thread.
#[derive(Debug, Clone, Default)]
pub(crate) struct Lane<N> {
    pub memory: Vec<N>,
    pub pc: u32,
    /// The return addresses of the calls that the lane is in.
    pub calls: Vec<u32>,
    pub trips: u64,
    /// Steps of this call so far. A copy counts by its length.
    pub steps: u64,
    pub killed: bool,
}

/// What all lanes share.
#[derive(Clone, Copy)]
pub struct Env<'e> {
    pub program: &'e Program,
    pub bound: &'e BoundTextures,
    pub loop_limit: u64,
    /// Whether the lane is part of a quad.
    pub quad: bool,
}

impl Env<'_> {
    /// The place of an instruction in the text that naga parsed.
    pub fn span(&self, pc: u32) -> naga::Span {
        self.program.spans.get(pc as usize).copied().unwrap_or_default()
    }
}

/// Why a lane stopped.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum LaneStop {
    /// The function has returned.
    Done,
    /// The instruction at `pc` needs the other lanes of the quad.
    Quad,
    /// The instruction before `pc` is a barrier.
    Barrier,
}

/// Runs until the function returns or needs its neighbours.
fn run_lane<N: Number>(env: Env, lane: &mut Lane<N>, watch: &mut Watch) -> Result<LaneStop, Error> {
    loop {
        if let Some(stop) = step_lane(env, lane, watch)? {
            return Ok(stop);
        }
    }
}

/// Runs one instruction. An observed run is made of the same steps.
#[inline(always)]
fn step_lane<N: Number>(
    env: Env,
    lane: &mut Lane<N>,
    watch: &mut Watch,
) -> Result<Option<LaneStop>, Error> {
    let at = lane.pc;
    let instruction = lane.fetch(env)?;
    match *instruction {
        Instruction::Jump { to } => lane.pc = to,
        Instruction::JumpUnless { condition, to } if lane.word(condition) == 0 => lane.pc = to,
        Instruction::JumpUnless { .. } => {}
        Instruction::Mark { point } => watch.hits[point as usize] += 1,
        Instruction::Trip => {
            lane.trips += 1;
            if lane.trips > env.loop_limit {
                return Err(endless_loop(env, at));
            }
        }
        Instruction::Switch { selector, table } => {
            lane.pc = jump_target(env.program, table, lane.word(selector))
        }
        Instruction::Call { to } => {
            lane.calls.push(lane.pc);
            lane.pc = to;
        }
        Instruction::Return => match lane.calls.pop() {
            Some(to) => lane.pc = to,
            None => return Ok(Some(LaneStop::Done)),
        },
        Instruction::Kill => lane.killed = true,
        Instruction::Barrier => return Ok(Some(LaneStop::Barrier)),
        Instruction::Derivative { .. } => {
            lane.pc = at;
            return Ok(Some(LaneStop::Quad));
        }
        Instruction::Image { access }
            if env.quad && env.program.images[access as usize].implicit() =>
        {
            lane.pc = at;
            return Ok(Some(LaneStop::Quad));
        }
        Instruction::Image { access } => {
            let access = &env.program.images[access as usize];
            texture::apply_access(env, access, &mut lane.memory[..], None, (at, watch))?
        }
        _ => lane.compute(instruction, at, watch),
    }
    Ok(None)
}

impl<N: Number> Lane<N> {
    /// Begins a call at an instruction.
    fn start(&mut self, entry: u32) {
        (self.pc, self.trips, self.killed) = (entry, 0, false);
        self.steps = 0;
        self.calls.clear();
    }

    /// Fetches the next instruction, advances `pc` and counts the steps.
    #[inline(always)]
    fn fetch<'e>(&mut self, env: Env<'e>) -> Result<&'e Instruction, Error> {
        let at = self.pc;
        let Some(instruction) = env.program.code.get(at as usize) else {
            return Err(lost_place(env.program, at));
        };
        self.pc += 1;
        self.steps += instruction.steps();
        if self.steps > EVAL_STEPS {
            return Err(too_many_steps(env, at));
        }
        Ok(instruction)
    }

    /// Runs an instruction that only reads and writes memory.
    #[inline(always)]
    fn compute(&mut self, instruction: &Instruction, at: u32, watch: &mut Watch) {
        let mut doubt = false;
        compute(instruction, &mut self.memory, &mut doubt);
        if doubt {
            watch.note(FindingKind::Ambiguous, at);
        }
        if watch.sanitize {
            watch.inspect(instruction, &self.memory, at);
        }
    }

    #[inline(always)]
    pub fn word(&self, slot: u32) -> u32 {
        self.memory[slot as usize].word()
    }
}

pub fn jump_target(program: &Program, table: u32, selector: u32) -> u32 {
    let table = &program.tables[table as usize];
    table.cases.iter().find(|case| case.0 == selector).map_or(table.default, |case| case.1)
}

#[cold]
fn endless_loop(env: Env, pc: u32) -> Error {
    let message = format!("the loops of this call made more than {} trips", env.loop_limit);
    Error::new(codes::EVAL_LOOP_LIMIT, message).or_at(env.span(pc))
}

#[cold]
fn too_many_steps(env: Env, pc: u32) -> Error {
    let message = format!("this call takes more than {EVAL_STEPS} steps");
    Error::new(codes::EVAL_LOOP_LIMIT, message).or_at(env.span(pc))
}

#[cold]
fn lost_place(program: &Program, pc: u32) -> Error {
    Error::new(codes::EVAL_INTERNAL, format!("no instruction {pc} of {}", program.code.len()))
}

impl<N: Number> Machine<'_, N> {
    /// Runs a function on the four fragments of a quad, in the order (0, 0), (1, 0), (0, 1),
    /// (1, 1), and gives their flattened results.
    ///
    /// Where only some of the fragments reach a derivative, it is 0 for those whose neighbour is
    /// missing, and it is reported.
    ///
    /// # Errors
    /// Those of [`Self::call`].
    pub fn quad(&mut self, id: FunctionId, arguments: [&[N]; 4]) -> Result<[Vec<N>; 4], Error> {
        N::run_quad(self, id, arguments)
    }

    /// [`Self::quad`].
    pub(crate) fn run_quad(
        &mut self,
        id: FunctionId,
        arguments: [&[N]; 4],
    ) -> Result<[Vec<N>; 4], Error> {
        let program = self.program;
        let mut lanes = std::mem::take(&mut self.quad);
        lanes.resize_with(4, || self.lane.clone());
        let mut entry = None;
        for (lane, arguments) in lanes.iter_mut().zip(arguments) {
            let function = callable_function(program, id, arguments.len())?;
            self.check_buffers(function)?;
            begin_lane(program, lane, true);
            place_arguments(lane, function, arguments);
            lane.start(function.entry);
            entry = Some(function);
        }
        let outcomes = self.together(&mut lanes);
        self.killed = [0, 1, 2, 3].map(|index| lanes.get(index).is_some_and(|lane| lane.killed));
        let results = std::array::from_fn(|index| {
            entry
                .zip(lanes.get(index))
                .map_or(Vec::new(), |(function, lane)| result_slots(lane, function).to_vec())
        });
        self.quad = lanes;
        outcomes.map(|()| results)
    }

    /// Whether each fragment of the last quad ran into `discard`.
    pub fn quad_discarded(&self) -> [bool; 4] {
        self.killed
    }

    fn together(&mut self, lanes: &mut [Lane<N>]) -> Result<(), Error> {
        let env = Env {
            program: self.program,
            bound: &self.resolved,
            loop_limit: self.loop_limit,
            quad: true,
        };
        let mut running = [true; 4];
        loop {
            let mut waiting = Vec::new();
            for index in (0..4).filter(|index| running[*index]).collect::<Vec<_>>() {
                match run_lane(env, &mut lanes[index], &mut self.watch)? {
                    LaneStop::Done => running[index] = false,
                    LaneStop::Quad => waiting.push(index),
                    LaneStop::Barrier => return Err(needs_workgroup(env.program, lanes[index].pc)),
                }
            }
            let group = first_group(lanes, &waiting);
            let Some(&first) = group.first() else { return Ok(()) };
            meet(env, lanes, &group, lanes[first].pc, &mut self.watch)?;
        }
    }
}

/// The waiting lanes that are furthest behind, which go on first: the others may wait at a place that
/// these still reach.
fn first_group<N>(lanes: &[Lane<N>], waiting: &[usize]) -> Vec<usize> {
    let behind = waiting
        .iter()
        .min_by(|a, b| waiting_position(&lanes[**a]).cmp(waiting_position(&lanes[**b])));
    let Some(&first) = behind else { return Vec::new() };
    let is_there =
        |index: &usize| waiting_position(&lanes[*index]).eq(waiting_position(&lanes[first]));
    waiting.iter().copied().filter(is_there).collect()
}

/// Runs the instruction at which lanes have met. Gives the gradients of what these read of a texture.
fn meet<N: Number>(
    env: Env<'_>,
    lanes: &mut [Lane<N>],
    group: &[usize],
    at: u32,
    watch: &mut Watch,
) -> Result<[Option<texture::Gradient>; 4], Error> {
    if group.len() < 4 {
        watch.note(FindingKind::DivergentDerivative, at);
    }
    let gradients = met(env, at, lanes, group, watch)?;
    for &index in group {
        lanes[index].pc += 1;
    }
    Ok(gradients)
}

/// Runs an instruction for the lanes that have met at it. Gives the gradients of what these read of a
/// texture.
fn met<N: Number>(
    env: Env<'_>,
    at: u32,
    lanes: &mut [Lane<N>],
    group: &[usize],
    watch: &mut Watch,
) -> Result<[Option<texture::Gradient>; 4], Error> {
    match env.program.code[at as usize] {
        Instruction::Derivative { axis, coarse, n, to, a } => {
            for i in 0..u32::from(n) {
                derivative(lanes, group, axis, coarse, (to + i) as usize, a.at(i));
            }
            Ok([None; 4])
        }
        Instruction::Image { access } => texture::run_quad(env, access, lanes, group, watch),
        _ => Ok([None; 4]),
    }
}

/// Where a lane waits: the return addresses of its calls, then its instruction.
fn waiting_position<N>(lane: &Lane<N>) -> impl Iterator<Item = u32> + '_ {
    lane.calls.iter().copied().chain([lane.pc])
}

/// The two lanes whose difference is the derivative for a lane.
pub fn derivative_lanes(lane: usize, axis: DerivativeDirection, coarse: bool) -> (usize, usize) {
    let lane = if coarse { 0 } else { lane };
    match axis {
        DerivativeDirection::Y => (lane & 1, lane | 2),
        _ => (lane & 2, lane | 1),
    }
}

fn derivative<N: Number>(
    lanes: &mut [Lane<N>],
    group: &[usize],
    axis: DerivativeDirection,
    coarse: bool,
    to: usize,
    from: usize,
) {
    let values: [Option<N>; 4] =
        std::array::from_fn(|index| group.contains(&index).then(|| lanes[index].memory[from]));
    let mut doubt = false;
    for &index in group {
        let mut along = |axis| {
            let (low, high) = derivative_lanes(index, axis, coarse);
            match (values[low], values[high]) {
                (Some(low), Some(high)) => N::binary(Binary::Subtract, high, low, &mut doubt),
                _ => N::default(),
            }
        };
        let result = match axis {
            DerivativeDirection::Width => {
                let [x, y] = [along(DerivativeDirection::X), along(DerivativeDirection::Y)]
                    .map(|slope| N::unary(Unary::Abs, slope, &mut false));
                N::binary(Binary::Add, x, y, &mut false)
            }
            axis => along(axis),
        };
        lanes[index].memory[to] = result;
    }
}
