//! One text to every target.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::bundle::{Artifact, Target, Unit};
use crate::compose::Composed;
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::emit::{self, targets};
use crate::validate::{self, Validated, validate};

/// Validates a text, reflects its entry point and writes it for each target; with the unit, lints.
pub fn compile(composed: &Composed, entry: &str, targets: &[Target]) -> Result<(Unit, Diagnostics), Diagnostics> {
    let validated = validate(composed)?;
    let unit = unit(&validated, entry, targets).map_err(|error| vec![error])?;
    Ok((unit, validate::lint(composed, &validated)))
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
