//! A run as events: statements with the values that they gave, calls, and ends of loops.
//!
//! Nothing is kept: a turn of a loop that is asked for later is run again.

use std::collections::BTreeMap;

use lamplight_eval::{
    Action, Error, Executed, FunctionId, Observer, SlotRange, TextureRead, Traced, Variable,
    VariableKind, VariablePlace,
};

use crate::mark::{Mark, Notice};
use crate::subject::{Ended, Subject};
use crate::text::StatementId;
use crate::value::Value;
use crate::walk::{Frame, Loop, Motion, Walk};

/// How a run is recorded.
#[derive(Debug, Clone, Copy)]
pub struct Options {
    /// The share of a value that its bound may have before its digits count as lost.
    pub share: f64,
    /// How many turns of each loop have values. Steps of later turns have none, unless something
    /// is marked there.
    pub turns: u64,
}

impl Default for Options {
    fn default() -> Self {
        Self { share: 0.01, turns: 2 }
    }
}

/// A value that a statement gave a name, or stored.
#[derive(Debug, Clone, PartialEq)]
pub struct Change {
    /// Its number among the program's variables.
    pub variable: usize,
    /// Its name; `return` for a result.
    pub name: String,
    /// The value after the statement.
    pub value: Value,
}

/// How a statement decided what runs next.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// A condition, and whether it holds.
    Condition(bool),
    /// The word that chose a case.
    Case(u32),
    /// The function ended.
    Return,
    /// The fragment is discarded.
    Discard,
}

/// A statement that ran.
#[derive(Debug, Clone, PartialEq)]
pub struct Step {
    /// The statement; `None` for what nobody wrote.
    pub statement: Option<StatementId>,
    /// How many calls deep.
    pub depth: usize,
    /// The function that it is in.
    pub function: FunctionId,
    /// The turns of all loops around it, the outermost first.
    pub turns: Vec<u64>,
    /// What it gave a name or stored, in this order.
    pub changes: Vec<Change>,
    /// What it decided.
    pub outcomes: Vec<Outcome>,
    /// What it read of textures.
    pub textures: Vec<TextureRead>,
    /// What is to be looked at.
    pub marks: Vec<Mark>,
}

/// What happens in a run, in order. A statement comes after the calls that it makes.
#[derive(Debug, Clone, PartialEq)]
pub enum Event {
    /// A function is called.
    Call {
        /// Which one.
        function: FunctionId,
        /// How many calls deep its statements are.
        depth: usize,
        /// The turns of all loops around the call.
        turns: Vec<u64>,
        /// Its parameters.
        arguments: Vec<Change>,
        /// Arguments that documentation excludes.
        marks: Vec<Mark>,
    },
    /// A statement ran.
    Step(Step),
    /// A loop ended after some turns.
    Left {
        /// Its statement.
        statement: Option<StatementId>,
        /// How many calls deep.
        depth: usize,
        /// The turns of all loops around it.
        turns: Vec<u64>,
        /// How many it made.
        made: u64,
    },
}

impl Event {
    /// Whether it is in the first turns of all loops, or something is marked there.
    pub fn is_shown(&self, options: Options) -> bool {
        let (turns, is_marked) = match self {
            Self::Call { turns, marks, .. } => (turns, !marks.is_empty()),
            Self::Step(step) => (&step.turns, !step.marks.is_empty()),
            Self::Left { turns, .. } => (turns, false),
        };
        is_marked || turns.iter().all(|turn| *turn <= options.turns)
    }
}

/// Runs a subject and shows its events.
///
/// # Errors
/// The evaluator's, after the events up to it.
pub fn record(
    subject: &Subject,
    options: Options,
    see: &mut dyn FnMut(Event),
) -> Result<Ended<Traced>, Error> {
    let mut recorder = Recorder::new(subject, options, see);
    let ended = subject.run::<Traced>(&mut recorder);
    if ended.is_err() {
        recorder.finish_all();
    }
    ended
}

/// What is known of a statement that runs.
#[derive(Default)]
struct Pending {
    changes: Vec<Change>,
    outcomes: Vec<Outcome>,
    textures: Vec<TextureRead>,
    marks: Vec<Mark>,
}

struct Recorder<'a> {
    subject: &'a Subject,
    options: Options,
    see: &'a mut dyn FnMut(Event),
    walk: Walk,
    /// One for each frame.
    pending: Vec<Pending>,
    is_started: bool,
    /// Variables that statements store to, by their first slot.
    stored: Vec<(u32, u32, usize)>,
    /// The values that each statement names.
    named: Vec<Vec<usize>>,
    /// The pointers that are parameters of each function.
    pointers: BTreeMap<FunctionId, Vec<usize>>,
    notice: Notice,
}

impl<'a> Recorder<'a> {
    fn new(subject: &'a Subject, options: Options, see: &'a mut dyn FnMut(Event)) -> Self {
        let (stored, named) = (stored_variables(subject), named_values(subject));
        Self {
            subject,
            options,
            see,
            walk: Walk::new(subject.function()),
            pending: Vec::new(),
            is_started: false,
            stored,
            named,
            pointers: pointers(subject),
            notice: Notice::new(options.share),
        }
    }

    fn has_values(&self, turns: &[u64]) -> bool {
        turns.iter().all(|turn| *turn <= self.options.turns)
    }

    /// Shows the statement of a frame, which has ended.
    fn finish(&mut self, depth: usize, memory: Option<&[Traced]>) {
        let Some(frame) = self.walk.frames.get(depth) else { return };
        let (function, statement) = (frame.function, frame.statement);
        let Some(pending) = self.pending.get_mut(depth).map(std::mem::take) else { return };
        let Pending { mut changes, outcomes, textures, marks } = pending;
        let turns = self.walk.turns();
        if self.has_values(&turns) || !marks.is_empty() {
            let named = statement.and_then(|statement| self.named.get(statement as usize));
            for index in named.into_iter().flatten().copied() {
                let variable = &self.subject.program.variables()[index];
                if let Some(memory) = memory.filter(|_| variable.function == Some(function)) {
                    changes.push(change_of(index, variable, memory));
                }
            }
        }
        let step = Step { statement, depth, function, turns, changes, outcomes, textures, marks };
        (self.see)(Event::Step(step));
    }

    /// Shows the statements in which a run was that did not end.
    fn finish_all(&mut self) {
        for depth in (0..self.walk.frames.len()).rev() {
            self.finish(depth, None);
        }
    }

    fn leave(&mut self, depth: usize, left: &[Loop]) {
        for one in left {
            let (statement, made, turns) = (one.statement, one.turn, self.walk.turns());
            (self.see)(Event::Left { statement, depth, turns, made });
        }
    }

    fn call(&mut self, function: FunctionId, depth: usize, memory: &[Traced]) {
        let (subject, turns) = (self.subject, self.walk.turns());
        let (mut arguments, mut marks) = (Vec::new(), Vec::new());
        let parameters =
            subject.variables_of(function).filter(|(_, one)| one.kind == VariableKind::Parameter);
        for (index, variable) in parameters {
            let change = change_of(index, variable, memory);
            marks.extend(self.notice.argument(subject, (function, index), &change.value));
            arguments.push(change);
        }
        self.pending.push(Pending::default());
        (self.see)(Event::Call { function, depth, turns, arguments, marks });
    }

    /// Notes what an instruction wrote to variables.
    fn note_written(&mut self, seen: &Executed<'_, Traced>) {
        let range = seen.written();
        if range.is_empty() {
            return;
        }
        let after = self.stored.partition_point(|(first, _, _)| *first < range.end);
        for at in (0..after).rev() {
            let (_, end, index) = self.stored[at];
            if end <= range.start {
                break;
            }
            let variable = &self.subject.program.variables()[index];
            let owner = |frame: &Frame| variable.function == Some(frame.function);
            let depth = self.walk.frames.iter().rposition(owner).unwrap_or(seen.depth);
            self.change(depth, index, seen.memory);
            if depth != seen.depth {
                self.change_behind(seen, &range);
            }
        }
    }

    /// Notes what was written behind the pointers of a function.
    fn change_behind(&mut self, seen: &Executed<'_, Traced>, range: &SlotRange) {
        let function = self.walk.frames.get(seen.depth).map(|frame| frame.function);
        let pointers = function.and_then(|function| self.pointers.get(&function)).cloned();
        for index in pointers.unwrap_or_default() {
            let variable = &self.subject.program.variables()[index];
            let first = variable.place.slot(0, seen.memory);
            if first < range.end && range.start < first + variable.shape.scalars() {
                self.change(seen.depth, index, seen.memory);
            }
        }
    }

    fn change(&mut self, depth: usize, index: usize, memory: &[Traced]) {
        let change = change_of(index, &self.subject.program.variables()[index], memory);
        let Some(pending) = self.pending.get_mut(depth) else { return };
        match pending.changes.iter_mut().find(|one| one.variable == index) {
            Some(known) => *known = change,
            None => pending.changes.push(change),
        }
    }

    fn mark(&mut self, depth: usize, mark: Mark) {
        if let Some(pending) = self.pending.get_mut(depth) {
            pending.marks.push(mark);
        }
    }

    /// Notes what an instruction did, in the statement that it belongs to.
    fn note(&mut self, seen: &Executed<'_, Traced>) {
        for mark in self.notice.instruction(seen) {
            self.mark(seen.depth, mark);
        }
        self.note_written(seen);
        let outcome = match seen.action {
            Action::Branch { holds, .. } => Outcome::Condition(holds),
            Action::Switch { selector } => Outcome::Case(selector),
            Action::Discard => Outcome::Discard,
            Action::Texture => {
                let read = seen.texture();
                if let Some(pending) = self.pending.get_mut(seen.depth) {
                    pending.textures.extend(read);
                }
                return;
            }
            _ => return,
        };
        if let Some(pending) = self.pending.get_mut(seen.depth) {
            pending.outcomes.push(outcome);
        }
    }
}

impl Observer<Traced> for Recorder<'_> {
    fn ahead(&mut self, next: &mut Executed<'_, Traced>) -> Result<(), Error> {
        if !std::mem::replace(&mut self.is_started, true) {
            self.call(self.subject.function(), 0, next.memory);
        }
        let motion: Motion = self.walk.end(&self.subject.statements, next);
        if motion.is_ended {
            if next.action == Action::Return
                && let Some(pending) = self.pending.get_mut(next.depth)
            {
                pending.outcomes.push(Outcome::Return);
            }
            self.finish(next.depth, Some(next.memory));
        }
        self.leave(next.depth, &motion.left);
        self.walk.begin(&self.subject.statements, next, &motion);
        match next.action {
            Action::Call { function } => self.call(function, next.depth + 1, next.memory),
            Action::Return => self.pending.truncate(next.depth.max(1)),
            _ => {}
        }
        Ok(())
    }

    fn see(&mut self, seen: &mut Executed<'_, Traced>) -> Result<(), Error> {
        let frame = self.walk.frames.get(seen.depth);
        let is_moving = matches!(seen.action, Action::Call { .. } | Action::Return);
        if !is_moving && frame.is_some_and(|frame| frame.statement.is_some()) {
            self.note(seen);
        }
        Ok(())
    }
}

/// A variable with its value.
pub(crate) fn change_of(index: usize, variable: &Variable, memory: &[Traced]) -> Change {
    let value = Value::read(&variable.shape, variable.place, memory);
    Change { variable: index, name: variable.name.clone(), value }
}

/// The first slot, the slot after the last one, and the number of each variable that can be stored to.
pub(crate) fn stored_variables(subject: &Subject) -> Vec<(u32, u32, usize)> {
    let all = subject.program.variables().iter().enumerate();
    let mut stored: Vec<(u32, u32, usize)> = all
        .filter_map(|(index, variable)| {
            let is_stored = matches!(
                variable.kind,
                VariableKind::Var | VariableKind::Private | VariableKind::Result
            );
            match variable.place {
                VariablePlace::At { slot, stride: _ } if is_stored => {
                    Some((slot, slot + variable.shape.scalars(), index))
                }
                _ => None,
            }
        })
        .collect();
    stored.sort_unstable();
    stored
}

/// The pointers that are parameters, by their function.
fn pointers(subject: &Subject) -> BTreeMap<FunctionId, Vec<usize>> {
    let mut found: BTreeMap<FunctionId, Vec<usize>> = BTreeMap::new();
    for (index, variable) in subject.program.variables().iter().enumerate() {
        if let (Some(function), VariableKind::Parameter, VariablePlace::Through { .. }) =
            (variable.function, variable.kind, variable.place)
        {
            found.entry(function).or_default().push(index);
        }
    }
    found
}

/// The values that each statement names.
fn named_values(subject: &Subject) -> Vec<Vec<usize>> {
    let mut named = vec![Vec::new(); subject.statements.all().len()];
    for (index, variable) in subject.program.variables().iter().enumerate() {
        if variable.kind != VariableKind::Let {
            continue;
        }
        if let Some(list) =
            subject.statements.of_variable(index).and_then(|at| named.get_mut(at as usize))
        {
            list.push(index);
        }
    }
    named
}
