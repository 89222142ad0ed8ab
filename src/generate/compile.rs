//! One text to every target.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use rayon::prelude::*;

use super::entry::Entry;
use super::sink::Sink;
use super::weave::Text;
use crate::bundle::{Artifact, Digest, Target, Unit};
use crate::cache::{Cache, Job};
use crate::compose::{Composed, Language};
use crate::diagnostic::{Diagnostic, Diagnostics, codes};
use crate::emit::{self, targets};
use crate::link::{self, Key, Linker, Outline, Taken, Whole};
use crate::validate::{self, Validated, validate};

/// What comes of a text: a unit, and what its author can mend.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Made {
    pub unit: Unit,
    pub warnings: Diagnostics,
}

/// What is left of [`Made`] when the unit has gone to the sink.
#[derive(Debug)]
pub struct Compiled {
    pub digest: Digest,
    pub warnings: Diagnostics,
}

/// Compiles texts, all for the same targets, and passes on what comes of them.
pub struct Compiler<'a> {
    pub targets: &'a [Target],
    pub sink: &'a dyn Sink,
    pub cache: Option<&'a Cache>,
    pub linker: Linker<'a>,
}

/// What a text needs.
enum Plan<'a> {
    /// Nothing: the cache knew it.
    Found(Result<Made, Diagnostics>),
    /// To be compiled as it is.
    Whole,
    /// To be linked, after it was compiled for those functions that no text before it has.
    Link(Outline<'a>, BTreeSet<Key>),
}

impl Compiler<'_> {
    /// Makes every text of a batch, unless the cache knows what comes of it, and gives the units to
    /// the sink. Which texts are compiled and which are linked depends on their order alone.
    pub fn make(&self, batch: &[(&Text, &Entry)]) -> Vec<Result<Compiled, Diagnostics>> {
        let read = batch.par_iter().map(|(text, entry)| match self.cache.and_then(|cache| cache.find(self.job(text, entry))) {
            Some(made) => (Some(made), None),
            None if entry.language == Language::Wesl => (None, self.linker.outline(&text.lean.text, &entry.name)),
            None => (None, None),
        });
        let (found, outlines): (Vec<_>, Vec<_>) = read.unzip();
        let claims = self.linker.claim(&outlines);
        let plans = found.into_iter().zip(outlines).zip(claims).map(|((found, outline), new)| match (found, outline) {
            (Some(made), _) => Plan::Found(made),
            (None, None) => Plan::Whole,
            (None, Some(outline)) => Plan::Link(outline, new),
        });
        let plans: Vec<Plan<'_>> = plans.collect();
        let taken: Vec<Option<Taken>> = plans.par_iter().zip(batch).map(|(plan, (text, entry))| self.lead(plan, text, entry)).collect();
        self.linker.keep(taken.into_iter().flatten());
        let made = plans.into_par_iter().zip(batch).map(|(plan, (text, entry))| self.finish(plan, text, entry)).collect();
        self.linker.forget();
        made
    }

    fn job<'j>(&'j self, text: &'j Text, entry: &'j Entry) -> Job<'j> {
        Job { text: &text.lean.text, composed: &text.composed, entry: &entry.name, options: &entry.options, targets: self.targets }
    }

    fn lead(&self, plan: &Plan<'_>, text: &Text, entry: &Entry) -> Option<Taken> {
        let Plan::Link(outline, new) = plan else { return None };
        let whole = if new.is_empty() { None } else { whole(text, &entry.name, outline, self.targets).ok().flatten() };
        whole.and_then(|whole| self.linker.take(outline, whole, new).ok())
    }

    fn finish(&self, plan: Plan<'_>, text: &Text, entry: &Entry) -> Result<Compiled, Diagnostics> {
        let result = match plan {
            Plan::Found(made) => return self.pass_on(made?),
            Plan::Whole => compile(text, &entry.name, self.targets),
            Plan::Link(outline, claimed) => match self.linker.link(&outline, &claimed) {
                Some(unit) => Ok(Made { unit, warnings: Vec::new() }),
                None => self.alone(text, entry, &outline),
            },
        };
        self.cache.into_iter().for_each(|cache| cache.keep(self.job(text, entry), &result));
        self.pass_on(result?)
    }

    /// The text from its own functions; as it is, where it cannot be taken apart.
    fn alone(&self, text: &Text, entry: &Entry, outline: &Outline<'_>) -> Result<Made, Diagnostics> {
        let linked = whole(text, &entry.name, outline, self.targets)?.and_then(|whole| self.linker.alone(outline, whole).ok());
        linked.map_or_else(|| compile(text, &entry.name, self.targets), |unit| Ok(Made { unit, warnings: Vec::new() }))
    }

    fn pass_on(&self, made: Made) -> Result<Compiled, Diagnostics> {
        let Made { unit, warnings } = made;
        let digest = self.sink.add(unit).map_err(|error| vec![Diagnostic::error(codes::BUNDLE_FAILED, error.to_string())])?;
        Ok(Compiled { digest, warnings })
    }
}

/// What a text with an outline compiles to, names marked; `None` where there is more to say of it
/// than its units.
fn whole(text: &Text, entry: &str, outline: &Outline<'_>, targets: &[Target]) -> Result<Option<Whole>, Diagnostics> {
    let sorted = Composed { text: outline.sorted(), ..text.lean.clone() };
    let validated = validate(&sorted).or_else(|_| validate(&text.composed))?;
    if validate::has_lints(&validated) {
        return Ok(None);
    }
    let reflection = Arc::new(emit::reflect(&validated, entry).map_err(|error| vec![error])?);
    let marked = Validated { language: validated.language, module: link::marked(&validated.module), info: validated.info.clone() };
    let emitted = targets.iter().map(|&target| emit::emit(if target == Target::SPIRV { &validated } else { &marked }, entry, target));
    let emitted = emitted.collect::<Result<Vec<_>, _>>().map_err(|error| vec![error])?;
    Ok(Some(Whole { reflection, emitted }))
}

/// Validates a text, reflects its entry point and writes it for each target.
fn compile(text: &Text, entry: &str, targets: &[Target]) -> Result<Made, Diagnostics> {
    let whole = || validate(&text.composed);
    // The lean text is quick to read; the whole one knows where its mistakes are.
    let validated = validate(&text.lean).or_else(|_| whole())?;
    emit::check(&text.lean, &validated).or_else(|_| emit::check(&text.composed, &whole()?))?;
    let unit = unit(&validated, entry, targets).map_err(|error| vec![error])?;
    // The lean text has no places to tell of.
    let warnings = if validate::has_lints(&validated) { validate::lint(&text.composed, &whole()?) } else { Vec::new() };
    Ok(Made { unit, warnings })
}

fn unit(validated: &Validated, entry: &str, targets: &[Target]) -> Result<Unit, Diagnostic> {
    let reflection = Arc::new(emit::reflect(validated, entry)?);
    let artifacts = targets.iter().map(|&target| Ok((target.name().to_owned(), artifact(validated, entry, target)?)));
    Ok(Unit { reflection, targets: artifacts.collect::<Result<BTreeMap<_, _>, Diagnostic>>()? })
}

fn artifact(validated: &Validated, entry: &str, target: Target) -> Result<Artifact, Diagnostic> {
    let emitted = emit::emit(validated, entry, target)?;
    let extension = targets::find(target).map_or("", |entry| entry.extension).to_owned();
    Ok(Artifact { bytes: emitted.bytes.into(), extension, native: Arc::new(emitted.native) })
}
