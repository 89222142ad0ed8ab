//! `lamplight variants`: what a manifest's axes multiply to.

use std::io::{Write, stdout};
use std::path::PathBuf;

use clap::Args;

use super::failure::{DiagnosticForm, Failure, warn};
use crate::diagnostic::nearest;
use crate::permute::report::{Report, report};
use crate::project;
use crate::source::SourceSet;

/// Report how many permutations a manifest has, and what each axis costs.
#[derive(Args)]
pub struct Arguments {
    /// The manifest [default: that of the library].
    #[arg(long, value_name = "FILE")]
    manifest: Option<PathBuf>,
    /// As JSON.
    #[arg(long)]
    json: bool,
    /// Also list every key of this program.
    #[arg(long, value_name = "PROGRAM")]
    keys: Option<String>,
}

pub fn run(arguments: Arguments, form: DiagnosticForm) -> Result<(), Failure> {
    let (sources, manifest) = match &arguments.manifest {
        Some(path) => open(path)?,
        None => project::library_manifest().map_err(|(sources, diagnostics)| Failure::Input(sources, diagnostics))?,
    };
    warn(&sources, &manifest.warnings, form);
    if let Some(name) = &arguments.keys {
        return keys(&manifest, name);
    }
    let reports: Vec<Report> = manifest.programs.iter().map(|program| report(&program.name, &program.space)).collect();
    if arguments.json {
        return Ok(writeln!(stdout(), "{:#}", serde_json::json!(reports))?);
    }
    let texts: Vec<String> = reports.iter().map(ToString::to_string).collect();
    Ok(stdout().write_all(texts.join("\n").as_bytes())?)
}

fn open(path: &std::path::Path) -> Result<(SourceSet, crate::permute::Manifest), Failure> {
    let mut sources = SourceSet::default();
    match project::read_manifest(path, &mut sources) {
        Ok(manifest) => Ok((sources, manifest)),
        Err(diagnostics) => Err(Failure::Input(sources, diagnostics)),
    }
}

fn keys(manifest: &crate::permute::Manifest, name: &str) -> Result<(), Failure> {
    let program = manifest.program(name).ok_or_else(|| {
        let known = manifest.programs.iter().map(|program| program.name.as_str());
        let hint = nearest(name, known).map_or(String::new(), |near| format!("; did you mean `{near}`?"));
        Failure::input(format!("the manifest declares no program `{name}`{hint}"))
    })?;
    let mut out = std::io::BufWriter::new(stdout().lock());
    for point in program.space.enumerate() {
        writeln!(out, "{}", program.space.key(&point))?;
    }
    Ok(out.flush()?)
}
