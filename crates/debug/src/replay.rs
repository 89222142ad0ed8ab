//! A run that goes forth and back.
//!
//! A run is the same each time, so going back is running again, up to a place before. Copies of the
//! run at some places make that short: a few over all of it, and a few over the part that was run
//! again last. Their number is bounded, so a long loop needs no more memory than a short one.

use std::collections::BTreeMap;

use lamplight_eval::{Action, Error, Executed, FunctionId, Observer, Paced, Traced, VariableKind};

use crate::mark::{Mark, Notice};
use crate::record::change_of;
use crate::subject::Subject;
use crate::text::StatementId;
use crate::walk::{Frame, Walk};

/// How many bytes all copies of a run may need. Beside them are the run itself, and one that goes from
/// a copy to the place that is looked for.
const BYTES: usize = 96 << 20;
/// The most copies of each kind. A run with so much memory that no copy is allowed begins again for
/// each step back.
const MOST: usize = 96;
/// How many halts are at least between two copies.
const APART: u64 = 64;
/// How many instructions run until somebody is asked whether to go on.
const PATIENCE: u32 = 4096;

/// Why a run is where it is.
#[derive(Debug, Clone, PartialEq)]
pub enum Halt {
    /// Nothing has run.
    Start,
    /// A statement is next.
    Statement,
    /// A call came back to a statement that has not ended.
    Returned(FunctionId),
    /// A statement did something that is marked.
    Marked,
    /// The run has ended.
    End,
    /// It ended with an error.
    Failed(Error),
}

/// A mark with its place.
#[derive(Debug, Clone, PartialEq)]
pub struct Marked {
    /// What is marked.
    pub mark: Mark,
    /// The statement; `None` at a call, whose function is marked.
    pub statement: Option<StatementId>,
    /// The function.
    pub function: FunctionId,
    /// The number of the halt, from 1.
    pub clock: u64,
}

/// A place of a run, as far as it is known from outside of the evaluator.
#[derive(Debug, Clone)]
pub struct Place {
    /// The functions that run, with their statements and loops.
    walk: Walk,
    /// How many halts there were.
    clock: u64,
    halt: Halt,
    /// How often each statement has begun.
    runs: Vec<u32>,
    marks: Vec<Marked>,
    notice: Notice,
    is_started: bool,
    /// The function that has just returned.
    returned: Option<FunctionId>,
    /// How many frames are shown: the last one may be that of a call that the statement makes first.
    shown: usize,
    /// Set by the observer.
    next: Option<Halt>,
}

impl Place {
    /// Why the run is here.
    pub fn halt(&self) -> &Halt {
        &self.halt
    }

    /// How many halts there were.
    pub fn clock(&self) -> u64 {
        self.clock
    }

    /// The functions that run, the innermost last.
    pub fn frames(&self) -> &[Frame] {
        &self.walk.frames[..self.shown.min(self.walk.frames.len())]
    }

    /// How many calls deep it is.
    pub fn depth(&self) -> usize {
        self.frames().len()
    }

    /// The statement that is next, or in which the run is.
    pub fn statement(&self) -> Option<StatementId> {
        self.frames().last().and_then(|frame| frame.statement)
    }

    /// How often a statement has begun.
    pub fn runs(&self, statement: StatementId) -> u32 {
        self.runs.get(statement as usize).copied().unwrap_or(0)
    }

    /// All marks so far.
    pub fn marks(&self) -> &[Marked] {
        &self.marks
    }

    /// The marks that were set by what ran last.
    pub fn new_marks(&self) -> impl Iterator<Item = &Marked> {
        self.marks.iter().filter(|marked| marked.clock == self.clock)
    }
}

/// A run at one of its places. A copy of it goes on from there.
#[derive(Debug, Clone)]
struct Moment {
    run: Paced<Traced>,
    place: Place,
    /// Whether the observer has seen the next instruction.
    is_looked: bool,
    /// How many moves there are until somebody is asked whether to go on.
    patience: u32,
}

/// What is asked at each halt.
pub struct Seen<'a> {
    /// What runs.
    pub subject: &'a Subject,
    /// Where it is.
    pub place: &'a Place,
    /// The memory of the fragment.
    pub memory: &'a [Traced],
}

/// Whether a search for a halt found one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Found {
    /// The run is there.
    Yes,
    /// The run is at its end, or at its beginning.
    No,
    /// Somebody wants it to stop.
    Interrupted,
}

/// A run that goes forth and back.
pub struct Replay {
    subject: Subject,
    now: Moment,
    /// Copies over all of the run, by their clocks.
    kept: BTreeMap<u64, Moment>,
    /// How many halts are between two of them.
    apart: u64,
    /// Copies over the part that was run again last.
    near: BTreeMap<u64, Moment>,
    /// The most copies of each kind.
    most: usize,
    share: f64,
}

impl Replay {
    /// A run before its first instruction. Digits count as lost if the bound of a value is above that
    /// share of it.
    ///
    /// # Errors
    /// The evaluator's, about what the function reads.
    pub fn new(subject: Subject, share: f64) -> Result<Self, Error> {
        let now = Moment::first(&subject, share)?;
        let most = (BYTES / 2 / now.bytes()).min(MOST);
        let kept = (most > 0).then(|| (0, now.clone())).into_iter().collect();
        Ok(Self { subject, now, kept, apart: APART, near: BTreeMap::new(), most, share })
    }

    /// What runs.
    pub fn subject(&self) -> &Subject {
        &self.subject
    }

    /// Where the run is.
    pub fn seen(&self) -> Seen<'_> {
        let Moment { run, place, is_looked: _, patience: _ } = &self.now;
        Seen { subject: &self.subject, place, memory: run.memory() }
    }

    /// How many copies of the run there are.
    pub fn copies(&self) -> usize {
        self.kept.len() + self.near.len()
    }

    /// How many bytes the copies need.
    pub fn copied_bytes(&self) -> usize {
        self.kept.values().chain(self.near.values()).map(Moment::bytes).sum()
    }

    /// Whether the fragment is discarded.
    pub fn is_discarded(&self) -> bool {
        self.now.run.is_discarded()
    }

    /// Goes on to the first halt that is wanted, or to the end of the run.
    pub fn forward(
        &mut self,
        wanted: &mut dyn FnMut(&Seen<'_>) -> bool,
        is_interrupted: &dyn Fn() -> bool,
    ) -> Found {
        loop {
            match self.now.go_on(&self.subject, is_interrupted) {
                Gone::Halted => {}
                Gone::Ended => return Found::No,
                Gone::Interrupted => return Found::Interrupted,
            }
            self.keep();
            if wanted(&self.seen()) {
                return Found::Yes;
            }
        }
    }

    /// Goes back to the last halt before this one that is wanted, or to the first of all.
    pub fn back(
        &mut self,
        wanted: &mut dyn FnMut(&Seen<'_>) -> bool,
        is_interrupted: &dyn Fn() -> bool,
    ) -> Found {
        let mut limit = self.now.place.clock;
        loop {
            let Some(mut moment) = self.before(limit) else { return Found::No };
            let from = moment.place.clock;
            let mut last = None;
            while moment.place.clock + 1 < limit {
                match moment.go_on(&self.subject, is_interrupted) {
                    Gone::Halted => {}
                    Gone::Ended => break,
                    Gone::Interrupted => return Found::Interrupted,
                }
                let Moment { run, place, is_looked: _, patience: _ } = &moment;
                let seen = Seen { subject: &self.subject, place, memory: run.memory() };
                if wanted(&seen) {
                    last = Some(place.clock);
                }
            }
            match last {
                Some(clock) => {
                    self.restore(clock);
                    return Found::Yes;
                }
                None if from == 0 => {
                    self.restore(1);
                    return Found::No;
                }
                None => limit = from + 1,
            }
        }
    }

    /// A copy of the run at a place from which it comes to at least one halt before `limit`, which may
    /// be its beginning.
    fn before(&self, limit: u64) -> Option<Moment> {
        let until = limit.saturating_sub(1).max(1);
        let last =
            |of: &BTreeMap<u64, Moment>| of.range(..until).next_back().map(|(clock, _)| *clock);
        let (near, kept) = (last(&self.near), last(&self.kept));
        let found = match near > kept {
            true => self.near.get(&near?),
            false => kept.and_then(|clock| self.kept.get(&clock)),
        };
        found.cloned().or_else(|| Moment::first(&self.subject, self.share).ok())
    }

    /// Goes to a halt that the run has come to before.
    fn restore(&mut self, clock: u64) {
        let Some(mut moment) = self.before(clock + 1) else { return };
        let half = (self.most as u64 / 2).max(1);
        let apart = (clock.saturating_sub(moment.place.clock) / half).max(APART);
        if clock.saturating_sub(moment.place.clock) > apart {
            self.near.clear();
        }
        let mut next = moment.place.clock + apart;
        while moment.place.clock < clock && moment.go_on(&self.subject, &|| false) == Gone::Halted {
            if moment.place.clock == next && self.near.len() < self.most {
                self.near.insert(next, moment.clone());
                next += apart;
            }
        }
        self.now = moment;
    }

    /// Keeps a copy, if it is time for one. Where there are too many, every second goes.
    fn keep(&mut self) {
        let clock = self.now.place.clock;
        let last = self.kept.last_key_value().map_or(0, |(clock, _)| *clock);
        if clock < last + self.apart {
            return;
        }
        if self.kept.len() >= self.most {
            self.apart *= 2;
            let apart = self.apart;
            self.kept.retain(|clock, _| clock % apart == 0);
        }
        if clock.is_multiple_of(self.apart) && self.kept.len() < self.most {
            self.kept.insert(clock, self.now.clone());
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Gone {
    Halted,
    Ended,
    Interrupted,
}

impl Moment {
    /// The beginning of a run.
    fn first(subject: &Subject, share: f64) -> Result<Self, Error> {
        let place = Place {
            walk: Walk::new(subject.function()),
            clock: 0,
            halt: Halt::Start,
            runs: vec![0; subject.statements.all().len()],
            marks: Vec::new(),
            notice: Notice::new(share),
            is_started: false,
            returned: None,
            shown: 1,
            next: None,
        };
        Ok(Self { run: subject.start()?, place, is_looked: false, patience: PATIENCE })
    }

    /// About how many bytes it needs.
    fn bytes(&self) -> usize {
        let place = size_of_val(&self.place.runs[..]) + size_of_val(&self.place.marks[..]);
        size_of::<Self>() + self.run.bytes() + place
    }

    /// Goes on to the next halt. The end is one, and nothing comes after it.
    fn go_on(&mut self, subject: &Subject, is_interrupted: &dyn Fn() -> bool) -> Gone {
        if matches!(self.place.halt, Halt::End | Halt::Failed(_)) {
            return Gone::Ended;
        }
        loop {
            self.patience -= 1;
            if self.patience == 0 {
                self.patience = PATIENCE;
                if is_interrupted() {
                    return Gone::Interrupted;
                }
            }
            match self.move_once(subject) {
                Ok(()) if self.run.has_ended() => self.place.next = Some(Halt::End),
                Ok(()) => {}
                Err(error) => self.place.next = Some(Halt::Failed(error)),
            }
            if let Some(halt) = self.place.next.take() {
                self.place.clock += 1;
                self.place.halt = halt;
                return Gone::Halted;
            }
        }
    }

    /// Shows the next instruction, or runs it if it was shown.
    fn move_once(&mut self, subject: &Subject) -> Result<(), Error> {
        let mut follower = Follower { subject, place: &mut self.place };
        self.is_looked = !self.is_looked;
        match self.is_looked {
            true => self.run.look(&subject.program, &mut follower),
            false => self.run.step(&subject.program, &mut follower),
        }
    }
}

/// Follows a run.
struct Follower<'a> {
    subject: &'a Subject,
    place: &'a mut Place,
}

impl Follower<'_> {
    fn mark(&mut self, mark: Mark, statement: Option<StatementId>, function: FunctionId) {
        let clock = self.place.clock + 1;
        self.place.marks.push(Marked { mark, statement, function, clock });
        self.place.next = Some(Halt::Marked);
    }

    /// Marks the arguments of a call that documentation excludes.
    fn mark_arguments(&mut self, function: FunctionId, memory: &[Traced]) {
        let subject = self.subject;
        for (index, variable) in subject.variables_of(function) {
            let is_documented = variable.kind == VariableKind::Parameter
                && subject.documented(function, &variable.name).is_some();
            if is_documented {
                let value = change_of(index, variable, memory).value;
                let mark = self.place.notice.argument(subject, (function, index), &value);
                if let Some(mark) = mark {
                    self.mark(mark, None, function);
                }
            }
        }
    }
}

impl Observer<Traced> for Follower<'_> {
    fn ahead(&mut self, next: &mut Executed<'_, Traced>) -> Result<(), Error> {
        let statements = &self.subject.statements;
        if !std::mem::replace(&mut self.place.is_started, true) {
            self.mark_arguments(self.subject.function(), next.memory);
        }
        let motion = self.place.walk.end(statements, next);
        let returned = self.place.returned.take();
        if next.action == Action::Return && next.depth > 0 {
            let frame = self.place.walk.frames.get(next.depth);
            self.place.returned = frame.map(|frame| frame.function);
        }
        self.place.walk.begin(statements, next, &motion);
        self.place.shown = self.place.walk.frames.len();
        if let Action::Call { function } = next.action {
            self.mark_arguments(function, next.memory);
        }
        if motion.is_begun {
            self.place.shown = next.depth + 1;
            let runs = &mut self.place.runs;
            let begun = self.place.walk.frames.get(next.depth).and_then(|frame| frame.statement);
            if let Some(runs) = begun.and_then(|begun| runs.get_mut(begun as usize)) {
                *runs += 1;
            }
            self.place.next = Some(Halt::Statement);
        } else if let Some(function) = returned
            && next.action != Action::Return
            && self.place.statement().is_some()
        {
            self.place.shown = next.depth + 1;
            self.place.next = Some(Halt::Returned(function));
        }
        Ok(())
    }

    fn see(&mut self, seen: &mut Executed<'_, Traced>) -> Result<(), Error> {
        let frame = self.place.walk.frames.get(seen.depth);
        let is_moving = matches!(seen.action, Action::Call { .. } | Action::Return);
        if let Some(frame) = frame.filter(|frame| !is_moving && frame.statement.is_some()) {
            let (function, statement) = (frame.function, frame.statement);
            for mark in self.place.notice.instruction(seen) {
                self.mark(mark, statement, function);
            }
        }
        Ok(())
    }
}
