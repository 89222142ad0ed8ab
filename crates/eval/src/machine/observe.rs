//! Runs that somebody watches, instruction by instruction.
//!
//! An observed run makes the same steps as any other run, and shows each of them ([`super::Paced`]).
//! Runs that nobody watches do not know of this module.

use super::{Env, Lane};
use crate::code::{Binary, Geometry, Instruction, Unary};
use crate::error::{Error, FindingKind};
use crate::flow::{SlotRange, read, written};
use crate::machine::texture::{self, Gradient, TextureRead};
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
    pub(super) env: Env<'m>,
    pub(super) gradient: Option<Gradient>,
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

pub(super) fn action_of<N: Number>(env: Env<'_>, lane: &Lane<N>, pc: u32) -> Action {
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
