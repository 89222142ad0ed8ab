//! One thread of the shader: its memory, its position in the code, and the loop that runs it.

use super::super::code::Instruction;
use super::super::error::{Error, FindingKind};
use super::super::number::Number;
use super::super::program::Program;
use super::super::resources::BoundTextures;
use super::compute::compute;
use super::texture;
use super::watch::Watch;
use lamplight_diagnostic::codes;
use lamplight_files::limits::EVAL_STEPS;

/// The state of one thread.
#[derive(Debug, Clone, Default)]
pub(super) struct Lane<N> {
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
pub(super) enum LaneStop {
    /// The function has returned.
    Done,
    /// The instruction at `pc` needs the other lanes of the quad.
    Quad,
}

/// Runs until the function returns or needs its neighbours.
pub(super) fn run_lane<N: Number>(
    env: Env,
    lane: &mut Lane<N>,
    watch: &mut Watch,
) -> Result<LaneStop, Error> {
    loop {
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
                None => return Ok(LaneStop::Done),
            },
            Instruction::Kill => lane.killed = true,
            Instruction::Derivative { .. } => {
                lane.pc = at;
                return Ok(LaneStop::Quad);
            }
            Instruction::Image { access }
                if env.quad && env.program.images[access as usize].implicit() =>
            {
                lane.pc = at;
                return Ok(LaneStop::Quad);
            }
            Instruction::Image { access } => {
                let access = &env.program.images[access as usize];
                texture::apply_access(env, access, &mut lane.memory[..], None, (at, watch))?
            }
            _ => lane.compute(instruction, at, watch),
        }
    }
}

impl<N: Number> Lane<N> {
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
