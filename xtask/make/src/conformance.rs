//! `cargo xtask conformance DIR...`: what the crate accepts and refuses of other people's suites,
//! beside what is expected there. Nothing of a suite is in the repository; `CONTRIBUTING.md` says
//! where they come from.

mod bevy;
mod compiled;
mod cts;
mod deqp;
mod folder;
mod glsl;
mod outputs;
mod table;
mod targets;
mod wesl;

use std::path::{Path, PathBuf};
use std::process::Command;

use lamplight::diagnostic::{Diagnostic, Severity, codes};
use lamplight::lint;
use lamplight::permute::Settings;
use lamplight::resolve::Packages;
use lamplight::source::SourceSet;
use lamplight_rules as rules;
use lamplight_validate::on_large_stack;

use table::Table;
use xtask::{CommandFailure, CommandResult};

/// A program of a suite.
pub struct Program {
    /// The test that it belongs to, or its file.
    pub name: String,
    pub text: String,
    /// Whether it is valid.
    pub expected: bool,
}

/// What a folder is.
enum Suite {
    /// gpuweb's CTS, of which the shader validation tests are run.
    Cts,
    /// The suite for composers of WESL.
    Wesl,
    /// dEQP's shader library.
    Deqp,
    /// The shaders of Bevy's crates.
    Bevy,
    /// Shaders in WGSL, of which Tint says whether they are valid.
    Folder,
}

impl Suite {
    fn of(folder: &Path) -> Self {
        match () {
            () if folder.join("src/webgpu/shader/validation").is_dir() => Self::Cts,
            () if folder.join(wesl::CASES).is_dir() => Self::Wesl,
            () if folder.join(deqp::FOLDERS[0]).is_dir() => Self::Deqp,
            () if folder.join(bevy::CRATES).is_dir() => Self::Bevy,
            () => Self::Folder,
        }
    }

    fn name(&self) -> &'static str {
        match self {
            Self::Cts => "cts",
            Self::Wesl => "wesl",
            Self::Deqp => "deqp",
            Self::Bevy => "bevy",
            Self::Folder => "folder",
        }
    }
}

/// Runs the suites in some folders.
pub fn run(arguments: &[String]) -> CommandResult {
    match arguments.split_first().map(|(first, rest)| (first.as_str(), rest)) {
        Some(("glsl", rest)) => return glsl::run(rest),
        Some(("targets", rest)) => return targets::run(rest),
        _ => {}
    }
    let (flags, folders): (Vec<&String>, Vec<&String>) =
        arguments.iter().partition(|argument| argument.starts_with("--"));
    let mut options = RunOptions::default();
    for flag in flags {
        match flag.as_str() {
            "--verbose" => options.verbose = true,
            "--outputs" => options.outputs = true,
            _ => return Err(CommandFailure::usage(format!("`{flag}` is not known"))),
        }
    }
    if folders.is_empty() {
        return Err(CommandFailure::usage(USAGE));
    }
    let mut differences = Vec::new();
    for folder in folders {
        let folder = PathBuf::from(folder);
        let suite = Suite::of(&folder);
        match options.outputs {
            true => differences.extend(validate_outputs(&suite, &folder)?.err()),
            false => differences.extend(compare_programs(&suite, &folder, options)?.err()),
        }
    }
    match differences.is_empty() {
        true => Ok(()),
        false => Err(CommandFailure::check(differences.join("\n"))),
    }
}

const USAGE: &str = "\
cargo xtask conformance [--verbose] DIR...
cargo xtask conformance --outputs DIR...
cargo xtask conformance targets [--record] DIR...
cargo xtask conformance glsl [-I DIR]... DIR...";

#[derive(Debug, Clone, Copy, Default)]
struct RunOptions {
    /// Whether each difference is printed.
    verbose: bool,
    /// Whether validators are asked about outputs, in the place of what is accepted.
    outputs: bool,
}

/// What is accepted and refused of a suite.
fn compare_programs(
    suite: &Suite,
    folder: &Path,
    options: RunOptions,
) -> Result<table::Comparison, CommandFailure> {
    let table = match suite {
        Suite::Cts => tabulate(&cts::programs(folder)?),
        Suite::Wesl => wesl::tabulate(folder)?,
        Suite::Deqp => deqp::tabulate(folder)?,
        Suite::Bevy => bevy::tabulate(folder)?,
        Suite::Folder => tabulate(&folder::programs(folder)?),
    };
    println!("{}: {}", folder.display(), table.programs());
    print!("{table}");
    if options.verbose {
        print!("{}", table.listed());
    }
    let comparison = table.compare(suite.name(), &commit_of(folder))?;
    if let Ok(note) = &comparison {
        println!("{note}");
    }
    Ok(comparison)
}

/// What validators say of the outputs of a suite's valid programs.
fn validate_outputs(suite: &Suite, folder: &Path) -> Result<table::Comparison, CommandFailure> {
    let name = match suite {
        Suite::Folder => folder.file_name().unwrap_or_default().to_string_lossy().into_owned(),
        _ => suite.name().to_owned(),
    };
    let table = match suite {
        Suite::Cts => outputs::tabulate(&name, &cts::programs(folder)?)?,
        Suite::Folder => outputs::tabulate(&name, &folder::programs(folder)?)?,
        Suite::Deqp => outputs::validate_units(&name, deqp::units_of_valid(folder)?)?,
        Suite::Wesl | Suite::Bevy => {
            let message = format!("`{}` has modules, and no programs", folder.display());
            return Err(CommandFailure::usage(message));
        }
    };
    print!("{}: {table}", folder.display());
    let words = "outputs, refused by validators";
    let counts = (&[table.outputs][..], &[table.refused()][..]);
    let line = format!("{}{name}", table::OUTPUTS);
    let comparison = table::compare_counts(&line, &commit_of(folder), words, counts)?;
    if let Ok(note) = &comparison {
        println!("{note}");
    }
    Ok(comparison)
}

/// The commit of a checkout; `-` where there is none.
fn commit_of(folder: &Path) -> String {
    let found = Command::new("git").arg("-C").arg(folder).args(["rev-parse", "HEAD"]).output();
    let printed = found.ok().filter(|output| output.status.success());
    printed.map_or_else(
        || "-".to_owned(),
        |output| String::from_utf8_lossy(&output.stdout).trim().to_owned(),
    )
}

fn tabulate(programs: &[Program]) -> Table {
    let mut table = Table::default();
    for program in programs {
        table.add(program, refusal(&program.text).as_ref());
    }
    table
}

/// Why the crate refuses a text for browsers: an error, or what is one for the target `wgsl`.
fn refusal(text: &str) -> Option<Diagnostic> {
    let is_wrong = |problem: &rules::Problem| problem.severity >= rules::Severity::Default;
    if let Some(problem) = on_large_stack(|| rules::check(text)).into_iter().find(is_wrong) {
        return Some(Diagnostic::error(codes::BROWSERS_REFUSE, problem.message));
    }
    let packages = Packages::of_text("shader.wgsl", text.to_owned());
    let (paths, settings) = (["shader.wgsl".to_owned()], Settings::default());
    let request =
        lint::Request { packages: &packages, manifest: None, settings: &settings, paths: &paths };
    let found = lint::lint(&mut SourceSet::default(), &request).diagnostics;
    found.into_iter().find(|one| one.severity == Severity::Error)
}
