//! Runs that somebody watches, instruction by instruction.
//!
//! An observed run makes the same steps as any other run, and shows each of them. Runs that nobody
//! watches do not know of this module.

use super::{Env, Lane, LaneStop, Machine, begin_lane, callable_function, place_arguments};
use super::{LaneRunner, needs_quad, needs_workgroup, result_slots, run_lane, step_lane};
use crate::code::{Binary, Geometry, Instruction, Unary};
use crate::error::{Error, FindingKind};
use crate::flow::{SlotRange, read, written};
use crate::machine::texture::{self, Gradient, TextureRead};
use crate::machine::watch::Watch;
use crate::number::Number;
use crate::program::FunctionId;
use naga::Span;

/// Sees each instruction of one lane before and after it runs.
pub trait Observer<N> {
    /// Called before an instruction. What is read of it is what it will do.
    ///
    /// # Errors
    /// Whatever ends the run.
    fn ahead(&mut self, next: &mut Executed<'_, N>) -> Result<(), Error>;

    /// Called after it.
    ///
    /// # Errors
    /// Whatever ends the run.
    fn see(&mut self, seen: &mut Executed<'_, N>) -> Result<(), Error>;
}

/// What an instruction did, as far as a reader of the author's text can notice.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Action {
    /// It wrote slots, or nothing.
    Write,
    /// It went on elsewhere.
    Jump,
    /// A block of statements begins; before that of a function, its variables get initial values.
    Begin,
    /// It decided a branch: whether the condition holds. Where it does not, or after the branch that
    /// was taken, the run goes on at an instruction that is at most `end`.
    Branch { holds: bool, end: u32 },
    /// It chose a case of a `switch` by this word.
    Switch { selector: u32 },
    /// It called a function.
    Call { function: FunctionId },
    /// The function ended.
    Return,
    /// A loop begins a turn. `last` is the last instruction of the loop.
    Turn { last: u32 },
    /// The fragment is discarded; it goes on for its neighbours.
    Discard,
    /// It read a texture.
    Texture,
}

/// An instruction that runs next, or has just run.
pub struct Executed<'m, N> {
    /// Its number in the program.
    pub pc: u32,
    /// Its place in the text that naga parsed.
    pub span: Span,
    /// What it did.
    pub action: Action,
    /// How many calls deep it is; 0 in the function that was called first.
    pub depth: usize,
    /// What was noticed there for the first time in this run.
    pub found: &'m [FindingKind],
    /// The memory.
    pub memory: &'m mut [N],
    env: Env<'m>,
    gradient: Option<Gradient>,
}

impl<N: Number> Executed<'_, N> {
    fn instruction(&self) -> &Instruction {
        self.env.program.instruction(self.pc).unwrap_or(&Instruction::Return)
    }

    /// The slots that it wrote.
    pub fn written(&self) -> SlotRange {
        written(self.env.program, self.instruction(), self.memory)
    }

    /// Calls `see` with the slots that it read.
    pub fn read(&self, see: &mut dyn FnMut(SlotRange)) {
        read(self.env.program, self.instruction(), self.memory, see);
    }

    /// Which argument its function has no result for, if it has such arguments.
    pub fn domain(&self) -> Option<&'static str> {
        Some(match self.instruction() {
            Instruction::Float1 { op, .. } => match op {
                Unary::Sqrt => "the root of a negative number",
                Unary::InverseSqrt => "the inverse root of a number that is not positive",
                Unary::Log | Unary::Log2 => "the logarithm of a number that is not positive",
                Unary::Acos => "the `acos` of a number outside [-1, 1]",
                Unary::Asin => "the `asin` of a number outside [-1, 1]",
                Unary::Atanh => "the `atanh` of a number outside [-1, 1]",
                Unary::Acosh => "the `acosh` of a number below 1",
                _ => return None,
            },
            Instruction::Float2 { op: Binary::Pow, .. } => {
                "`pow` with a negative base, or with the base 0 and an exponent that is not positive"
            }
            Instruction::Float2 { op: Binary::Atan2, .. } => "the `atan2` of two zeros",
            Instruction::Geometry { op: Geometry::Normalize, .. } => "a zero vector normalised",
            _ => return None,
        })
    }

    /// Where and what it read of a texture; `None` for another instruction.
    pub fn texture(&self) -> Option<TextureRead> {
        let Instruction::Image { access } = self.instruction() else { return None };
        texture::describe(self.env, self.env.program.access(*access)?, self.memory, self.gradient)
    }
}

/// What an observed run of a lane needs beside the lane.
struct Watching<'w, N> {
    observer: &'w mut dyn Observer<N>,
    fresh: Vec<FindingKind>,
}

impl<N: Number> Watching<'_, N> {
    fn show(
        &mut self,
        env: Env<'_>,
        (lane, watch): (&mut Lane<N>, &mut Watch),
        pc: u32,
        gradient: Option<Gradient>,
    ) -> Result<(), Error> {
        let action = action_of(env, lane, pc);
        // A call already has its return address, and a return no longer has it.
        let depth = match action {
            Action::Call { .. } => lane.calls.len().saturating_sub(1),
            Action::Return if pc + 1 != lane.pc => lane.calls.len() + 1,
            _ => lane.calls.len(),
        };
        watch.take_fresh(&mut self.fresh);
        let span = env.span(pc);
        let found = &self.fresh;
        let memory = &mut lane.memory[..];
        self.observer.see(&mut Executed { pc, span, action, depth, found, memory, env, gradient })
    }

    fn show_ahead(&mut self, env: Env<'_>, lane: &mut Lane<N>) -> Result<(), Error> {
        let (pc, depth) = (lane.pc, lane.calls.len());
        let (action, span) = (action_of(env, lane, pc), env.span(pc));
        let memory = &mut lane.memory[..];
        let (found, gradient) = (&[][..], None);
        let mut next = Executed { pc, span, action, depth, found, memory, env, gradient };
        self.observer.ahead(&mut next)
    }

    /// As [`super::run_lane`].
    fn run_lane(
        &mut self,
        env: Env<'_>,
        lane: &mut Lane<N>,
        watch: &mut Watch,
    ) -> Result<LaneStop, Error> {
        loop {
            let pc = lane.pc;
            self.show_ahead(env, lane)?;
            let stop = step_lane(env, lane, watch)?;
            if stop != Some(LaneStop::Quad) {
                self.show(env, (lane, watch), pc, None)?;
            }
            if let Some(stop) = stop {
                return Ok(stop);
            }
        }
    }
}

fn action_of<N: Number>(env: Env<'_>, lane: &Lane<N>, pc: u32) -> Action {
    let code = &env.program.code;
    match env.program.instruction(pc) {
        Some(Instruction::JumpUnless { condition, to }) => {
            // The branch that is taken ends with a jump behind the other one.
            let end = match code.get(to.saturating_sub(1) as usize) {
                Some(Instruction::Jump { to: end }) if *to > pc && end > to => *end,
                _ => (*to).max(pc + 1),
            };
            Action::Branch { holds: lane.word(*condition) != 0, end }
        }
        Some(Instruction::Jump { .. }) => Action::Jump,
        Some(Instruction::Switch { selector, .. }) => {
            Action::Switch { selector: lane.word(*selector) }
        }
        Some(Instruction::Call { to }) => match env.program.function_at(*to) {
            Some(function) => Action::Call { function },
            None => Action::Write,
        },
        Some(Instruction::Return) => Action::Return,
        Some(Instruction::Trip) => Action::Turn { last: last_of_loop(code, pc) },
        Some(Instruction::Mark { .. }) => Action::Begin,
        Some(Instruction::Kill) => Action::Discard,
        Some(Instruction::Image { .. }) => Action::Texture,
        _ => Action::Write,
    }
}

/// The jump back to the first instruction of a loop.
fn last_of_loop(code: &[Instruction], first: u32) -> u32 {
    let is_back = |instruction: &Instruction| matches!(instruction, Instruction::Jump { to } | Instruction::JumpUnless { to, .. } if *to == first);
    let after = code.iter().skip(first as usize).position(is_back);
    after.map_or(first, |after| first + after as u32)
}

impl<N: Number> Machine<'_, N> {
    /// As [`Self::call`], with an observer.
    ///
    /// # Errors
    /// Those of [`Self::call`], and what the observer ends the run with.
    pub fn observe_call(
        &mut self,
        id: FunctionId,
        arguments: &[N],
        observer: &mut dyn Observer<N>,
    ) -> Result<Vec<N>, Error> {
        let program = self.program;
        let function = callable_function(program, id, arguments.len())?;
        self.check_buffers(function)?;
        begin_lane(program, &mut self.lane, true);
        place_arguments(&mut self.lane, function, arguments);
        self.lane.start(function.entry);
        let env = Env { program, bound: &self.resolved, loop_limit: self.loop_limit, quad: false };
        let mut watching = Watching { observer, fresh: Vec::new() };
        match watching.run_lane(env, &mut self.lane, &mut self.watch)? {
            LaneStop::Done => Ok(result_slots(&self.lane, function).to_vec()),
            LaneStop::Barrier => Err(needs_workgroup(program, self.lane.pc)),
            LaneStop::Quad => Err(needs_quad(program, self.lane.pc)),
        }
    }

    /// As [`Self::quad`], with an observer of one of the four lanes. Findings are those of this lane.
    ///
    /// # Errors
    /// Those of [`Self::observe_call`].
    pub fn observe_quad(
        &mut self,
        id: FunctionId,
        arguments: [&[N]; 4],
        lane: usize,
        observer: &mut dyn Observer<N>,
    ) -> Result<[Vec<N>; 4], Error> {
        let others = Watch::new(self.program);
        let watching = Watching { observer, fresh: Vec::new() };
        self.run_quad_by(id, arguments, &mut OneOfFour { watching, lane, others })
    }
}

/// Runs a quad of which one lane is observed.
struct OneOfFour<'w, N> {
    watching: Watching<'w, N>,
    lane: usize,
    /// What the other lanes report, which is of no interest.
    others: Watch,
}

impl<N: Number> LaneRunner<N> for OneOfFour<'_, N> {
    fn run(
        &mut self,
        env: Env<'_>,
        index: usize,
        lane: &mut Lane<N>,
        watch: &mut Watch,
    ) -> Result<LaneStop, Error> {
        match index == self.lane {
            true => self.watching.run_lane(env, lane, watch),
            false => run_lane(env, lane, &mut self.others),
        }
    }

    fn met(
        &mut self,
        env: Env<'_>,
        index: usize,
        lane: &mut Lane<N>,
        watch: &mut Watch,
        gradient: Option<Gradient>,
    ) -> Result<(), Error> {
        match index == self.lane {
            true => {
                let pc = lane.pc;
                self.watching.show(env, (lane, watch), pc, gradient)
            }
            false => Ok(()),
        }
    }
}
