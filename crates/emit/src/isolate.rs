//! Reduces a module to one entry point and what it needs.

use naga::compact::{KeepUnused, compact};

use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};
use lamplight_validate::{Validated, guard, info_unchecked, on_large_stack};

/// Keeps one entry point and what it reaches.
///
/// # Errors
/// `unknown-entry-point`, and `naga-internal` where naga panics or rejects its own work.
pub fn isolate(validated: &Validated, entry: &str) -> Result<Validated, Diagnostics> {
    let index = super::find_target(validated, entry).map_err(|error| vec![error])?;
    on_large_stack(|| guard("", || keep_entry(validated, index)))
        .and_then(|result| result)
        .map_err(|error| vec![error])
}

/// [`isolate`] on the own stack, for the entry point of an index.
pub fn keep_entry(validated: &Validated, index: usize) -> Result<Validated, Diagnostic> {
    let mut module = validated.module.clone();
    module.entry_points = vec![module.entry_points.swap_remove(index)];
    compact(&mut module, KeepUnused::No);
    // The module is part of a valid one, so only the analysis is repeated and not the checks.
    let info = info_unchecked(&module).map_err(|error| {
        let message = format!("a compacted module is not valid: {error}");
        Diagnostic::error(codes::NAGA_INTERNAL, message)
    })?;
    Ok(Validated { module, info, portable: validated.portable })
}

/// The module of one entry point, in which every override is a constant: its default.
///
/// # Errors
/// `unknown-entry-point`, `override-without-value`, and `emit-failed` where a default cannot be
/// computed.
pub fn with_defaults(
    module: &naga::Module,
    entry: &str,
) -> Result<(naga::Module, naga::valid::ModuleInfo), Diagnostic> {
    let info = info_unchecked(module).map_err(|error| {
        Diagnostic::error(codes::NAGA_INTERNAL, format!("the module is not valid: {error}"))
    })?;
    let validated = Validated { module: module.clone(), info, portable: false };
    let index = super::find_target(&validated, entry)?;
    super::specialise::with_defaults(&validated, index)
}
