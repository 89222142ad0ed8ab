//! One text to every target.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::entry::Entry;
use super::sink::Sink;
use super::weave::Text;
use crate::bundle::{Artifact, Digest, Target, Unit};
use crate::cache::{Cache, Job};
use crate::diagnostic::{Diagnostic, Diagnostics, codes};
use crate::emit::{self, targets};
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
}

impl Compiler<'_> {
    /// Compiles a text, unless the cache knows what comes of it, and gives the unit to the sink.
    pub fn make(&self, text: &Text, entry: &Entry) -> Result<Compiled, Diagnostics> {
        let job =
            Job { text: &text.lean.text, composed: &text.composed, entry: &entry.name, options: &entry.options, targets: self.targets };
        let result = self.cache.and_then(|cache| cache.find(job)).unwrap_or_else(|| {
            let result = compile(text, &entry.name, self.targets);
            self.cache.into_iter().for_each(|cache| cache.keep(job, &result));
            result
        });
        let Made { unit, warnings } = result?;
        let digest = self.sink.add(unit).map_err(|error| vec![Diagnostic::error(codes::BUNDLE_FAILED, error.to_string())])?;
        Ok(Compiled { digest, warnings })
    }
}

/// Validates a text, reflects its entry point and writes it for each target.
fn compile(text: &Text, entry: &str, targets: &[Target]) -> Result<Made, Diagnostics> {
    let whole = || validate(&text.composed);
    // The lean text is quick to read; the whole one knows where its mistakes are.
    let validated = validate(&text.lean).or_else(|_| whole())?;
    emit::check(&text.lean, &validated).or_else(|_| emit::check(&text.composed, &whole()?))?;
    let unit = unit(&validated, entry, targets).map_err(|error| vec![error])?;
    let is_fine = validate::lint(&text.lean, &validated).is_empty();
    let warnings = if is_fine { Vec::new() } else { validate::lint(&text.composed, &whole()?) };
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
