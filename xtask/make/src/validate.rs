//! `cargo xtask validate [BUNDLE]`: lets the validators of all targets check every output of a
//! bundle.

use std::path::PathBuf;
use std::process::Command;

use lamplight::bundle::{BlobFile, Target, blob_files};
use lamplight::cache::Cache;
use lamplight_validators::{Extent, Output, Refusal, Tint, Verdict, missing, outputs, verdict};

use xtask::process::root;
use xtask::{CommandFailure, CommandResult, machine};

use crate::generate;
use crate::progress::show_progress;

/// How many refusals are printed.
const MOST_LISTED: usize = 20;

/// Validates all of a bundle directory, whatever passed before.
pub fn run(arguments: &[String]) -> CommandResult {
    let bundle = arguments.first().map_or_else(generate::bundle, PathBuf::from);
    let files = blob_files(&bundle)
        .map_err(|error| CommandFailure::input(format!("`{}`: {error}", bundle.display())))?;
    let Verdict { validation, refusals } = validate(files, Extent::All, None, &tint())?;
    print!("{validation}");
    let line = |refusal: &Refusal| {
        let Refusal { output: Output { target, file, .. }, validator, message, .. } = refusal;
        format!("{} ({target}): {validator}: {message}", file.display())
    };
    if !refusals.is_empty() {
        let lines: Vec<String> = refusals.iter().take(MOST_LISTED).map(line).collect();
        return Err(CommandFailure::check(lines.join("\n")));
    }
    match validation.missing().as_slice() {
        [] => Ok(()),
        missing => {
            let missing = missing.join("\n");
            Err(CommandFailure::environment(format!("not all outputs are validated:\n{missing}")))
        }
    }
}

/// Lets the installed validators check the outputs of their targets. Outputs that are known to pass
/// are not validated again.
pub fn validate(
    files: impl IntoIterator<Item = BlobFile>,
    extent: Extent,
    cache: Option<&Cache>,
    tint: &Tint,
) -> Result<Verdict, CommandFailure> {
    let outputs = outputs(files).map_err(|error| CommandFailure::input(error.to_string()))?;
    let progress = |done, total| show_progress("validating", done, total);
    verdict(outputs, extent, cache, tint, &progress).map_err(CommandFailure::environment)
}

/// Where Tint is, or is to be installed.
pub fn tint_folder() -> Tint {
    Tint::at(root().join("target/lamplight-tint"))
}

/// Tint below `target/`. If it is missing and npm is there, it is installed now.
pub fn tint() -> Tint {
    let tint = tint_folder();
    let is_missing = missing(Target::WGSL, &tint).is_some();
    if is_missing && machine::program("npm") && machine::program("node") {
        let [npm, arguments @ ..] = tint.install();
        eprintln!("installing Tint: {npm} {}", arguments.join(" "));
        // If this fails, Tint is reported as missing.
        let _ = Command::new(npm).args(arguments).stdout(std::io::stderr()).status();
    }
    tint
}
