//! `lamplight gen`: the bundle of a manifest.

use std::io::{Write, stdout};
use std::path::{Path, PathBuf};

use clap::Args;

use super::compile::target;
use super::failure::{DiagnosticForm, Failure, warn};
use super::progress::Bar;
use crate::bundle::{self, Bundle, Target};
use crate::diagnostic::Diagnostics;
use crate::generate::{Generated, Request, generate};
use crate::permute::Quoted;
use crate::project;
use crate::source::SourceSet;

/// Compose, compile and bundle every permutation of a manifest.
#[derive(Args)]
pub struct Arguments {
    /// The manifest.
    #[arg(long, value_name = "FILE", default_value = project::MANIFEST)]
    manifest: PathBuf,
    /// Folder of the bundle, or a single file that ends in `.lamplight`.
    #[arg(short, long, value_name = "DIR", default_value = "bundle")]
    out: PathBuf,
    /// Only this program.
    #[arg(long, value_name = "P")]
    program: Option<String>,
    /// Only this permutation.
    #[arg(long, value_name = "KEY")]
    only: Option<String>,
    /// Only these targets.
    #[arg(long, value_name = "T,...", value_delimiter = ',', value_parser = target)]
    target: Vec<Target>,
    /// Write nothing; compare with the bundle that is there.
    #[arg(long)]
    check: bool,
    /// The summary as JSON.
    #[arg(long)]
    json: bool,
}

pub fn run(arguments: Arguments, form: DiagnosticForm) -> Result<(), Failure> {
    let bar = Bar::new();
    let mut sources = SourceSet::default();
    let generated = generated(&arguments, &mut sources, &bar);
    bar.clear();
    let Generated { contents, summary, warnings } = generated.map_err(|diagnostics| Failure::Input(sources.clone(), diagnostics))?;
    warn(&sources, &warnings, form);
    match arguments.check {
        true => compare(&contents, &arguments.out)?,
        false => write(&contents, &arguments.out)?,
    }
    if arguments.json {
        return Ok(writeln!(stdout(), "{:#}", serde_json::json!(summary))?);
    }
    Ok(write!(stdout(), "{summary}")?)
}

fn generated(arguments: &Arguments, sources: &mut SourceSet, bar: &Bar) -> Result<Generated, Diagnostics> {
    let manifest = project::read_manifest(&arguments.manifest, sources)?;
    let root = arguments.manifest.parent().unwrap_or(Path::new(""));
    let packages = project::packages(root, sources)?;
    let only = arguments.only.as_ref().map(|key| {
        let id = sources.add("--only", key.as_str());
        Quoted::whole(sources, id)
    });
    let request = Request { program: arguments.program.clone(), only, targets: arguments.target.clone() };
    generate(sources, &packages, &manifest, &request, &|progress| bar.show(progress))
}

fn is_file(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension == "lamplight")
}

fn write(contents: &bundle::Contents, out: &Path) -> Result<(), Failure> {
    let written = if is_file(out) { bundle::write_file(contents, out) } else { bundle::write_directory(contents, out) };
    written.map_err(|error| Failure::environment(format!("cannot write `{}`: {error}", out.display())))
}

fn compare(contents: &bundle::Contents, out: &Path) -> Result<(), Failure> {
    let there = Bundle::open(out).and_then(|bundle| bundle.contents());
    let there = there.map_err(|error| Failure::check(format!("`{}`: {error}", out.display())))?;
    let difference = bundle::diff(&there, contents);
    if difference.is_empty() {
        return Ok(());
    }
    let changes = difference.permutations.iter().take(20);
    let lines: Vec<String> =
        changes.map(|change| format!("  {} {} {} {}", change.kind, change.program, change.entry, change.key)).collect();
    let count = difference.permutations.len();
    Err(Failure::check(format!("`{}` is not up to date: {count} permutations differ\n{}", out.display(), lines.join("\n"))))
}
