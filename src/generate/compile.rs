//! One text to every target.

use crate::bundle::{Native, Reflection, Target};
use crate::compose::Composed;
use crate::diagnostic::Diagnostics;
use crate::emit::{self, Emitted};
use crate::validate::validate;

/// A compiled text.
pub struct Unit {
    pub reflection: Reflection,
    pub outputs: Vec<Output>,
}

/// What one target made of it.
pub struct Output {
    pub target: Target,
    pub native: Native,
    pub bytes: Vec<u8>,
}

/// Validates a text, reflects its entry point and writes it for each target.
pub fn compile(composed: &Composed, entry: &str, targets: &[Target]) -> Result<Unit, Diagnostics> {
    let validated = validate(composed)?;
    let reflection = emit::reflect(&validated, entry).map_err(|error| vec![error])?;
    let outputs = targets.iter().map(|&target| {
        emit::emit(&validated, entry, target).map(|Emitted { bytes, native }| Output { target, native, bytes })
    });
    let outputs: Result<Vec<Output>, _> = outputs.collect();
    Ok(Unit { reflection, outputs: outputs.map_err(|error| vec![error])? })
}
