//! `cargo xtask validate [BUNDLE]`: lets the judges of all targets check every output of a bundle.

use std::path::PathBuf;
use std::process::Command;

use lamplight::bundle::{BlobFile, Target, blob_files};
use lamplight::cache::Cache;
use lamplight_validators::{MissingTool, Output, Refusal, Tint, missing, outputs, verdict};

use xtask::process::root;
use xtask::{CommandFailure, CommandResult, machine};

use crate::generate;

/// How many refusals are printed.
const TOLD: usize = 20;

/// Judges all of a bundle directory, whatever passed before.
pub fn run(arguments: &[String]) -> CommandResult {
    let bundle = arguments.first().map_or_else(generate::bundle, PathBuf::from);
    let files = blob_files(&bundle)
        .map_err(|error| CommandFailure::input(format!("`{}`: {error}", bundle.display())))?;
    let judged = judge(files, None)?;
    let line = |refusal: &Refusal| {
        let Refusal { output: Output { target, file, .. }, judge, words, .. } = refusal;
        format!("{} ({target}): {judge}: {words}", file.display())
    };
    match judged.refusals.as_slice() {
        [] => judged.complete(),
        refusals => {
            let lines: Vec<String> = refusals.iter().take(TOLD).map(line).collect();
            Err(CommandFailure::check(lines.join("\n")))
        }
    }
}

/// What the installed judges say, and which judges are missing.
pub struct JudgedOutputs {
    pub refusals: Vec<Refusal>,
    missing: Vec<MissingTool>,
}

impl JudgedOutputs {
    /// For a run in which no judge was asked.
    pub fn nothing() -> Self {
        Self { refusals: Vec::new(), missing: Vec::new() }
    }

    /// Fails if a judge was missing.
    pub fn complete(&self) -> CommandResult {
        if self.missing.is_empty() {
            return Ok(());
        }
        let lines: Vec<String> = self.missing.iter().map(MissingTool::to_string).collect();
        Err(CommandFailure::environment(format!(
            "not all outputs are judged:\n{}",
            lines.join("\n")
        )))
    }
}

/// Lets the installed judges check the outputs of their targets, and tells which judges are
/// missing. Outputs that are known to pass are not judged again.
pub fn judge(
    files: impl IntoIterator<Item = BlobFile>,
    cache: Option<&Cache>,
) -> Result<JudgedOutputs, CommandFailure> {
    let tint = tint();
    let mut outputs = outputs(files).map_err(|error| CommandFailure::input(error.to_string()))?;
    let mut lacking: Vec<MissingTool> = Vec::new();
    let mut targets: Vec<Target> = outputs.iter().map(|output| output.target).collect();
    targets.sort();
    targets.dedup();
    for target in targets {
        let found = missing(&[target], &tint);
        if !found.is_empty() {
            outputs.retain(|output| output.target != target);
            lacking.extend(found);
        }
    }
    lacking.sort();
    lacking.dedup();
    let start = std::time::Instant::now();
    let verdict = verdict(outputs, cache, &tint, &show).map_err(CommandFailure::environment)?;
    println!(
        "judged {} outputs in {:.1} s ({} passed before), {} refused",
        verdict.judged,
        start.elapsed().as_secs_f64(),
        verdict.known,
        verdict.refusals.len()
    );
    Ok(JudgedOutputs { refusals: verdict.refusals, missing: lacking })
}

/// Tint below `target/`. If it is missing and npm is there, it is installed now.
fn tint() -> Tint {
    let tint = Tint::at(root().join("target/lamplight-tint"));
    let is_missing = !missing(&[Target::WGSL], &tint).is_empty();
    if is_missing && machine::program("npm") && machine::program("node") {
        let [npm, arguments @ ..] = tint.install();
        eprintln!("installing Tint: {npm} {}", arguments.join(" "));
        // If this fails, Tint is reported as missing.
        let _ = Command::new(npm).args(arguments).stdout(std::io::stderr()).status();
    }
    tint
}

fn show(done: usize, total: usize) {
    use std::io::{IsTerminal, Write, stderr};
    if stderr().is_terminal() {
        let end = if done == total { "\n" } else { "" };
        let _ = write!(stderr(), "\rjudging {done} of {total}{end}");
    }
}
