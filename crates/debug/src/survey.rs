//! Which kinds of marks the fragments of a picture have, without their places.

use std::collections::{BTreeMap, BTreeSet};

use lamplight_eval::{
    Action, Error, Executed, FunctionId, Observer, Paced, Resources, Traced, VariableKind,
};

use crate::mark::{Mark, Notice};
use crate::subject::{Subject, argument_slots};
use crate::value::Value;
use crate::walk::Walk;

/// Runs one fragment after another of the function of a subject, with the same resources.
pub struct Survey {
    /// A run that never begins.
    first: Paced<Traced>,
    share: f64,
    /// The documented parameters of each function, by their numbers.
    documented: BTreeMap<FunctionId, Vec<usize>>,
}

impl Survey {
    /// Prepares the runs. `share` is that of [`crate::Options`], and `resources` are what the
    /// fragments read.
    ///
    /// # Errors
    /// The evaluator's, about the program and what it reads.
    pub fn new(subject: &Subject, resources: Resources, share: f64) -> Result<Self, Error> {
        let machine = subject.machine::<Traced>(resources)?;
        let count = subject.signature().map_or(0, |signature| signature.arguments.len());
        let none = vec![Traced::default(); count];
        let first = machine.pace_quad(subject.function(), [&none[..]; 4], 0)?;
        let mut documented: BTreeMap<FunctionId, Vec<usize>> = BTreeMap::new();
        for (index, variable) in subject.program.variables().iter().enumerate() {
            if variable.kind == VariableKind::Parameter
                && let Some(function) = variable.function
                && subject.documented(function, &variable.name).is_some()
            {
                documented.entry(function).or_default().push(index);
            }
        }
        Ok(Self { first, share, documented })
    }

    /// The names of the kinds of marks that a fragment of a quad has, as in [`Mark::KINDS`]. The
    /// subject is that of [`Self::new`].
    ///
    /// # Errors
    /// The evaluator's.
    pub fn fragment(
        &self,
        subject: &Subject,
        quad: &[Vec<f32>; 4],
        lane: usize,
    ) -> Result<BTreeSet<&'static str>, Error> {
        let kinds = subject.signature().map_or(&[][..], |signature| &signature.arguments);
        let all = quad.each_ref().map(|words| argument_slots::<Traced>(words, kinds));
        let arguments = all.each_ref().map(Vec::as_slice);
        let mut run = self.first.with_quad(&subject.program, arguments, lane)?;
        let mut looker = Looker {
            subject,
            documented: &self.documented,
            walk: Walk::new(subject.function()),
            notice: Notice::new(self.share),
            is_started: false,
            found: BTreeSet::new(),
        };
        run.finish(&subject.program, &mut looker)?;
        Ok(looker.found)
    }
}

/// Notes what a recorded run would be marked with.
struct Looker<'a> {
    subject: &'a Subject,
    documented: &'a BTreeMap<FunctionId, Vec<usize>>,
    walk: Walk,
    notice: Notice,
    is_started: bool,
    found: BTreeSet<&'static str>,
}

impl Looker<'_> {
    fn call(&mut self, function: FunctionId, memory: &[Traced]) {
        let subject = self.subject;
        for index in self.documented.get(&function).into_iter().flatten() {
            let Some(variable) = subject.program.variables().get(*index) else { continue };
            let value = Value::read(&variable.shape, variable.place, memory);
            let mark = self.notice.argument(subject, (function, *index), &value);
            self.found.extend(mark.as_ref().map(Mark::name));
        }
    }
}

impl Observer<Traced> for Looker<'_> {
    fn ahead(&mut self, next: &mut Executed<'_, Traced>) -> Result<(), Error> {
        let subject = self.subject;
        if !std::mem::replace(&mut self.is_started, true) {
            self.call(subject.function(), next.memory);
        }
        let motion = self.walk.end(&subject.statements, next);
        self.walk.begin(&subject.statements, next, &motion);
        if let Action::Call { function } = next.action {
            self.call(function, next.memory);
        }
        Ok(())
    }

    fn see(&mut self, seen: &mut Executed<'_, Traced>) -> Result<(), Error> {
        let frame = self.walk.frames.get(seen.depth);
        let is_moving = matches!(seen.action, Action::Call { .. } | Action::Return);
        if !is_moving && frame.is_some_and(|frame| frame.statement.is_some()) {
            self.found.extend(self.notice.instruction(seen).iter().map(Mark::name));
        }
        Ok(())
    }
}
