//! `cargo xtask validate [BUNDLE]`: every output of a bundle through the external validators.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;

use lamplight::bundle::blob_files;

use crate::external::{self, Job};
use crate::{Failure, Outcome, generate, machine};

/// Programs that judge outputs, with the Debian package that brings each.
const VALIDATORS: &[(&str, &str)] =
    &[("spirv-val", "spirv-tools"), ("glslangValidator", "glslang-tools")];

/// Outputs that passed, beside the bundle: files are named by their content, so that a name that
/// passed once passes always.
const PASSED: &str = "validated.txt";

/// Validates a bundle directory, all of it.
pub fn run(arguments: &[String]) -> Outcome {
    let bundle = arguments.first().map_or_else(generate::bundle, PathBuf::from);
    validate(&bundle, Earlier::Forget)
}

/// What to do with outputs that passed in an earlier run.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Earlier {
    Trust,
    Forget,
}

/// Judges every output of the bundle by the validators that are installed, and says which are not.
pub fn validate(bundle: &Path, earlier: Earlier) -> Outcome {
    let missing: Vec<_> =
        VALIDATORS.iter().filter(|(program, _)| !machine::program(program)).collect();
    for (program, package) in &missing {
        eprintln!("not validated: {program} is not installed (Debian package {package})");
    }
    if earlier == Earlier::Forget && !missing.is_empty() {
        return Err(Failure::environment(
            "install the validators: `cargo xtask test` does, where it may",
        ));
    }
    let versions = versions();
    let passed =
        if earlier == Earlier::Trust { read_passed(bundle, &versions) } else { BTreeSet::new() };
    let mut jobs = jobs(bundle)?;
    jobs.retain(|job| {
        job.is_covered()
            && !passed.contains(&name(job))
            && !missing.iter().any(|(program, _)| judges(program, job))
    });
    let (total, names) = (jobs.len(), jobs.iter().map(name).collect::<BTreeSet<_>>());
    let (judged, refusals) = external::validate(jobs, &|done| show(done, total))
        .map_err(|error| Failure::environment(error.to_string()))?;
    println!(
        "validated {judged} outputs ({} passed before), {} refused",
        passed.len(),
        refusals.len()
    );
    if refusals.is_empty() {
        return write_passed(bundle, &versions, passed.union(&names))
            .map_err(|error| Failure::environment(error.to_string()));
    }
    Err(Failure::check(refusals.into_iter().take(20).collect::<Vec<_>>().join("\n")))
}

fn judges(program: &str, job: &Job) -> bool {
    (program == "spirv-val") == (job.target == "spirv")
}

/// Every distinct output, with its stage.
fn jobs(bundle: &Path) -> Result<Vec<Job>, Failure> {
    let files = blob_files(bundle)
        .map_err(|error| Failure::input(format!("`{}`: {error}", bundle.display())))?;
    Ok(files
        .into_iter()
        .map(|file| Job {
            stage: external::stage(file.stage),
            target: file.target,
            file: file.path,
        })
        .collect())
}

fn name(job: &Job) -> String {
    job.file.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// What the validators call themselves, in one line: another version judges anew.
fn versions() -> String {
    let version = |program: &str| {
        Command::new(program).arg("--version").output().map_or(String::new(), |output| {
            String::from_utf8_lossy(&output.stdout).replace('\n', " ")
        })
    };
    VALIDATORS.iter().map(|(program, _)| version(program)).collect()
}

fn read_passed(bundle: &Path, versions: &str) -> BTreeSet<String> {
    let text = std::fs::read_to_string(bundle.with_file_name(PASSED)).unwrap_or_default();
    let mut lines = text.lines();
    if lines.next() == Some(versions) {
        lines.map(str::to_owned).collect()
    } else {
        BTreeSet::new()
    }
}

fn write_passed<'a>(
    bundle: &Path,
    versions: &str,
    names: impl Iterator<Item = &'a String>,
) -> std::io::Result<()> {
    let lines = names.fold(format!("{versions}\n"), |text, name| text + name + "\n");
    Ok(lamplight::output::write(&bundle.with_file_name(PASSED), lines.as_bytes())?)
}

fn show(done: usize, total: usize) {
    use std::io::{IsTerminal, Write, stderr};
    if stderr().is_terminal() {
        let _ = write!(
            stderr(),
            "\rvalidating {done} of {total}{}",
            if done == total { "\n" } else { "" }
        );
    }
}
