//! `cargo xtask conformance targets DIR...`: for which targets each WGSL file of other people's
//! projects compiles, and the reason of each blank. With `--record`, it writes the page
//! `docs/conformance.md`.

mod page;
mod probes;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;

use lamplight::bundle::Target;
use lamplight::compose::{Composed, Options};
use lamplight::diagnostic::{Diagnostic, Severity};
use lamplight::generate::entry_points;
use lamplight::link::{Linker, TextForms, compile};
use lamplight_validate::on_large_stack;
use rayon::prelude::*;

use super::commit_of;
use super::compiled::composed_wgsl;
use super::folder::files_below;
use xtask::process::root;
use xtask::{CommandFailure, CommandResult};

const PAGE: &str = "docs/conformance.md";

/// What becomes of a file.
enum Outcome {
    /// Tint refuses it, for this reason.
    Invalid(String),
    /// It has nothing that could be compiled alone.
    NoEntryPoint,
    /// For each target that it does not compile for, the reasons.
    Compiled(BTreeMap<Target, Vec<String>>),
}

/// The files of a project.
struct Project {
    name: String,
    commit: String,
    files: Vec<(String, Outcome)>,
}

/// Prints what becomes of the files of some checkouts.
pub fn run(arguments: &[String]) -> CommandResult {
    let records = arguments.iter().any(|argument| argument == "--record");
    let folders: Vec<PathBuf> =
        arguments.iter().filter(|argument| *argument != "--record").map(PathBuf::from).collect();
    if folders.is_empty() {
        return Err(CommandFailure::usage("cargo xtask conformance targets [--record] DIR..."));
    }
    let projects = folders.iter().map(|folder| read_project(folder)).collect::<Result<Vec<_>, _>>();
    let page = page::write_page(&projects?)?;
    let path = root().join(PAGE);
    if records {
        return std::fs::write(&path, page)
            .map_err(|error| CommandFailure::input(format!("`{PAGE}`: {error}")));
    }
    let recorded = std::fs::read_to_string(&path).unwrap_or_default();
    print!("{page}");
    match recorded == page {
        true => Ok(()),
        false => Err(CommandFailure::check(format!("`{PAGE}` differs: see `--record`"))),
    }
}

fn read_project(folder: &Path) -> Result<Project, CommandFailure> {
    let files = files_below(folder, "wgsl")?;
    let outcomes: Vec<_> =
        on_large_stack(|| files.par_iter().map(|file| outcome_of(file)).collect());
    let named = |(file, outcome): (&PathBuf, Result<Outcome, CommandFailure>)| {
        let name = file.strip_prefix(folder).unwrap_or(file).display().to_string();
        outcome.map(|outcome| (name, outcome))
    };
    let files = files.iter().zip(outcomes).map(named).collect::<Result<_, _>>()?;
    let name = folder.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let commit: String = commit_of(folder).chars().take(12).collect();
    Ok(Project { name, commit, files })
}

fn outcome_of(file: &Path) -> Result<Outcome, CommandFailure> {
    if let Some(reason) = refusal_of_tint(file)? {
        return Ok(Outcome::Invalid(reason));
    }
    let text = std::fs::read_to_string(file)
        .map_err(|error| CommandFailure::input(format!("`{}`: {error}", file.display())))?;
    Ok(match composed_wgsl(&text, Options::default().keep) {
        Ok(composed) => compiled(&composed),
        Err(errors) => refused(&errors),
    })
}

/// A file that compiles for no target.
fn refused(errors: &[Diagnostic]) -> Outcome {
    let every = Target::ALL.iter().map(|target| (*target, reasons_of(errors)));
    Outcome::Compiled(every.collect())
}

/// The first error of Tint, without its place.
fn refusal_of_tint(file: &Path) -> Result<Option<String>, CommandFailure> {
    let output = Command::new("tint").args(["--format", "wgsl"]).arg(file).output();
    let output = output.map_err(|error| CommandFailure::environment(format!("`tint`: {error}")))?;
    if output.status.success() {
        return Ok(None);
    }
    let printed = String::from_utf8_lossy(&output.stderr).into_owned();
    let line = printed.lines().find_map(|line| line.split_once("error: "));
    Ok(Some(line.map_or_else(|| "refused".to_owned(), |(_, message)| message.to_owned())))
}

/// Compiles every entry point for every target.
fn compiled(composed: &Composed) -> Outcome {
    let entries = match entry_points(composed) {
        Ok(entries) if entries.is_empty() => return Outcome::NoEntryPoint,
        Ok(entries) => entries,
        Err(errors) => return refused(&errors),
    };
    let forms = TextForms { composed, lean: composed };
    let mut blanks: BTreeMap<Target, Vec<String>> = BTreeMap::new();
    for target in Target::ALL {
        let targets = [*target];
        let linker = Linker::new(&targets);
        for (entry, _) in &entries {
            let made = compile(&forms, entry, &targets, &linker);
            let reasons = made.err().map(|errors| reasons_of(&errors)).unwrap_or_default();
            blanks.entry(*target).or_default().extend(reasons);
        }
    }
    for reasons in blanks.values_mut() {
        reasons.sort();
        reasons.dedup();
    }
    blanks.retain(|_, reasons| !reasons.is_empty());
    Outcome::Compiled(blanks)
}

/// The messages, without the names of targets and of what the author declared.
fn reasons_of(errors: &[Diagnostic]) -> Vec<String> {
    let errors = errors.iter().filter(|error| error.severity == Severity::Error);
    errors.flat_map(|error| page::general_reasons(&error.message)).collect()
}
