//! Follows a run from statement to statement: calls, and turns of loops.

use lamplight_eval::{Action, Executed, FunctionId, Number};

use crate::text::{StatementId, Statements};

/// A loop that runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Loop {
    first: u32,
    last: u32,
    /// Its statement, if somebody wrote it.
    pub statement: Option<StatementId>,
    /// Which turn it is in, from 1.
    pub turn: u64,
}

/// A function that runs.
#[derive(Debug, Clone)]
pub struct Frame {
    /// Which one.
    pub function: FunctionId,
    /// The statement that it is in.
    pub statement: Option<StatementId>,
    /// The loops that it is in, the innermost last.
    pub loops: Vec<Loop>,
}

/// Where a run is.
#[derive(Debug, Clone)]
pub struct Walk {
    /// The functions that run, the innermost last.
    pub frames: Vec<Frame>,
    /// How many statements have begun.
    pub begun: u64,
}

/// What an instruction means for the statements of its function.
#[derive(Debug, Default)]
pub struct Motion {
    /// The loops that ended before it, with the turns that they made.
    pub left: Vec<Loop>,
    /// Whether the statement before it ended.
    pub is_ended: bool,
    /// Whether a statement begins with it.
    pub is_begun: bool,
}

impl Walk {
    /// At the beginning of a call.
    pub fn new(function: FunctionId) -> Self {
        Self { frames: vec![Frame::new(function)], begun: 0 }
    }

    /// The turns of all loops that run, the outermost first.
    pub fn turns(&self) -> Vec<u64> {
        self.frames.iter().flat_map(|frame| &frame.loops).map(|one| one.turn).collect()
    }

    /// What an instruction ends. Call [`Self::begin`] after what has ended is dealt with.
    pub fn end<N: Number>(&mut self, statements: &Statements, seen: &Executed<'_, N>) -> Motion {
        let mut motion = Motion::default();
        let Some(frame) = self.frames.get_mut(seen.depth) else { return motion };
        while let Some(top) = frame.loops.last().copied()
            && !(top.first..=top.last).contains(&seen.pc)
        {
            frame.loops.pop();
            motion.left.push(top);
        }
        let at = statements.begun_by(seen.pc);
        motion.is_begun = at.is_some_and(|at| frame.statement != Some(at));
        let is_turn = matches!(seen.action, Action::Turn { .. });
        let ends = motion.is_begun || is_turn || seen.action == Action::Return;
        motion.is_ended = ends && frame.statement.is_some();
        motion
    }

    /// Moves on to the instruction.
    pub fn begin<N: Number>(
        &mut self,
        statements: &Statements,
        seen: &Executed<'_, N>,
        motion: &Motion,
    ) {
        let at = statements.at(seen.pc);
        let Some(frame) = self.frames.get_mut(seen.depth) else { return };
        if motion.is_begun {
            frame.statement = at;
            self.begun += 1;
        }
        match seen.action {
            Action::Turn { last } => {
                frame.statement = None;
                match frame.loops.last_mut().filter(|top| top.first == seen.pc) {
                    Some(top) => top.turn += 1,
                    None => frame.loops.push(Loop { first: seen.pc, last, statement: at, turn: 1 }),
                }
            }
            Action::Call { function } => self.frames.push(Frame::new(function)),
            Action::Return => self.frames.truncate(seen.depth.max(1)),
            _ => {}
        }
    }
}

impl Frame {
    fn new(function: FunctionId) -> Self {
        Self { function, statement: None, loops: Vec::new() }
    }
}
