//! `lamplight variants`: how many permutations a manifest's axes multiply to.

use std::io::Write;
use std::path::{Path, PathBuf};

use clap::Args;

use serde::Serialize;

use super::cached::Cached;
use super::cost;
use super::failure::{DiagnosticForm, Failure, print_warnings};
use super::overwrite::Overwrite;
use super::progress::Bar;
use super::terminal::stdout;
use crate::catalogue::cost::{PATH, SHOWN, is_record, package_costs};
use crate::cost::Meter;
use crate::cost::device::Device;
use crate::cost::permutations::CostChange;
use crate::diagnostic::{Diagnostics, nearest_name};
use crate::generate::{self, Discard, Request, Tools};
use crate::output;
use crate::permute::axis::Mode;
use crate::permute::report::{PermutationReport, StageCount, report};
use crate::permute::{Manifest, Program};
use crate::project;
use crate::resolve::Packages;
use crate::source::SourceSet;
use crate::spirv_opt::SpirvOpt;

/// Report how many permutations a manifest has, and what each axis costs.
#[derive(Args)]
pub struct Arguments {
    /// The manifest [default: `lamplight.toml` here or in the nearest folder above, else that of
    /// the library].
    #[arg(long, value_name = "FILE")]
    manifest: Option<PathBuf>,
    /// Print JSON.
    #[arg(long)]
    json: bool,
    /// List every key of this program instead.
    #[arg(long, value_name = "PROGRAM")]
    keys: Option<String>,
    /// Compose every permutation, count the distinct texts, and print which axes change each stage.
    #[arg(long)]
    compose: bool,
    /// Compile them too, and count the distinct outputs.
    #[arg(long)]
    compile: bool,
    /// Compile every permutation for GPUs, and print the cost that each value of an axis adds to a
    /// stage.
    #[arg(long)]
    pub cost: bool,
    #[command(flatten)]
    pub gpus: cost::Gpus,
    /// Write the costs on `navi21` to this file [default: `costs.toml` in the package's root, where
    /// the language server reads what the values of an axis cost].
    #[arg(long, value_name = "FILE", requires = "cost", num_args = 0..=1)]
    record: Option<Option<PathBuf>>,
    #[command(flatten)]
    cached: Cached,
    #[command(flatten)]
    overwrite: Overwrite,
}

pub fn run_variants(
    arguments: Arguments,
    opened: cost::OpenedGpus,
    form: DiagnosticForm,
) -> Result<(), Failure> {
    if arguments.gpus.are_named() && !arguments.cost {
        return Err(Failure::usage("`--gpu` chooses what `--cost` compiles for: add `--cost`"));
    }
    let mut sources = SourceSet::default();
    let manifest_path =
        arguments.manifest.clone().or_else(|| project::manifest_above(Path::new("")));
    let read = open_manifest(manifest_path.as_deref(), &mut sources);
    let (manifest, packages) =
        read.map_err(|diagnostics| Failure::Input(sources.clone(), diagnostics))?;
    print_warnings(&sources, &manifest.warnings, form);
    if let Some(name) = &arguments.keys {
        return print_keys(&manifest, name, arguments.json);
    }
    let devices = opened.map_err(Failure::environment)?;
    let path = manifest_path.as_deref();
    let record = arguments.record.as_ref();
    let record =
        record.map(|file| record_path(file.as_deref(), path, &packages, &devices)).transpose()?;
    let cache = if devices.is_empty() { None } else { arguments.cached.open(path)? };
    let report_of = |program: &Program| {
        let mut report = counted_report(program);
        if arguments.compose || arguments.compile {
            let bar = Bar::new();
            let composed =
                compose(&arguments, &mut sources, &packages, &manifest, program, &mut report, &bar);
            bar.clear();
            composed.map_err(|diagnostics| Failure::Input(sources.clone(), diagnostics))?;
        }
        let meter = Meter { devices: &devices, cache: cache.as_ref(), iterations: &[] };
        let changes = cost::axis_changes(&mut sources, &packages, &manifest, &program.name, meter)?;
        Ok(ProgramReport { report, changes })
    };
    let reports =
        manifest.programs.iter().map(report_of).collect::<Result<Vec<ProgramReport>, Failure>>()?;
    if let Some(path) = &record {
        write_record(&arguments, path, &devices, &reports)?;
    }
    if arguments.json {
        return Ok(writeln!(stdout(), "{:#}", serde_json::json!(reports))?);
    }
    let texts: Vec<String> = reports.iter().map(ProgramReport::text).collect();
    Ok(stdout().write_all(texts.join("\n").as_bytes())?)
}

/// What the axes of a program multiply to.
fn counted_report(program: &Program) -> PermutationReport {
    let mut report = report(&program.name, &program.space);
    if program.glsl.is_some() {
        let spec = program.space.axes().iter().filter(|axis| axis.mode == Mode::Spec);
        report.static_in_glsl = spec.map(|axis| axis.name.clone()).collect();
    }
    report
}

/// Where the costs of a package's axes are recorded.
///
/// # Errors
/// There is no package, the GPU that is recorded is not asked for, or the record has more than
/// axes.
fn record_path(
    file: Option<&Path>,
    manifest: Option<&Path>,
    packages: &Packages,
    devices: &[Device],
) -> Result<PathBuf, Failure> {
    if !devices.iter().any(|device| device.gpu.name == SHOWN) {
        return Err(Failure::usage(format!(
            "`--record` records the costs on `{SHOWN}`: add it to `--gpu`"
        )));
    }
    if let Some(file) = file {
        return Ok(file.to_owned());
    }
    let Some(manifest) = manifest else {
        return Err(Failure::usage(
            "`--record` writes into the package of a manifest, and there is no `lamplight.toml` \
             here or in a folder above: add `--manifest`, or name a file",
        ));
    };
    let folder = manifest.parent().unwrap_or(Path::new(""));
    let path = project::root_beside(folder).join(PATH);
    let known = package_costs(&mut SourceSet::default(), &packages.root).unwrap_or_default();
    if !known.functions.is_empty() || !known.expressions.is_empty() {
        return Err(Failure::input(format!(
            "`{}` also has the costs of functions, which this command does not measure",
            path.display()
        )));
    }
    Ok(path)
}

/// Records what the values of axes change.
fn write_record(
    arguments: &Arguments,
    path: &Path,
    devices: &[Device],
    reports: &[ProgramReport],
) -> Result<(), Failure> {
    let changes =
        reports.iter().map(|program| (program.report.program.as_str(), &*program.changes));
    let Some(costs) = cost::axis_record(devices, changes) else { return Ok(()) };
    let text = costs.text("lamplight variants --cost --record");
    Ok(output::write_file(path, text.as_bytes(), is_record, arguments.overwrite.replace())?)
}

/// The report of one program.
#[derive(Serialize)]
struct ProgramReport {
    #[serde(flatten)]
    report: PermutationReport,
    /// What values of axes change on GPUs, where that was asked for.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    changes: Vec<CostChange>,
}

impl ProgramReport {
    fn text(&self) -> String {
        match self.changes.as_slice() {
            [] => self.report.to_string(),
            changes => format!("{}\n{}", self.report, cost::changes_table(changes)),
        }
    }
}

/// The manifest of a path, or the library's, with its packages.
pub fn open_manifest(
    path: Option<&Path>,
    sources: &mut SourceSet,
) -> Result<(Manifest, Packages), Diagnostics> {
    match path {
        Some(path) => project::declared(path, sources),
        None => {
            let (library, manifest) =
                project::library_manifest().map_err(|(library, diagnostics)| {
                    *sources = library;
                    diagnostics
                })?;
            *sources = library;
            Ok((manifest, project::library_packages()))
        }
    }
}

/// Adds what only composing and compiling can tell.
fn compose(
    arguments: &Arguments,
    sources: &mut SourceSet,
    packages: &Packages,
    manifest: &Manifest,
    program: &Program,
    report: &mut PermutationReport,
    bar: &Bar,
) -> Result<(), Diagnostics> {
    let progress = |progress| bar.show(progress);
    let composed = generate::survey(sources, packages, program, &progress)?;
    let axes = || program.space.axes().iter().map(|axis| axis.name.clone());
    let stages = composed.entries.iter().map(|entry| StageCount {
        stage: format!("{} ({})", entry.entry, format!("{:?}", entry.language).to_lowercase()),
        unique: entry.unique as u64,
        unread: axes().filter(|axis| !entry.axes.contains(axis)).collect(),
    });
    report.stages = Some(stages.collect());
    report.unique_sources = Some(composed.entries.iter().map(|entry| entry.unique as u64).sum());
    if arguments.compile {
        let request = Request { program: Some(program.name.clone()), ..Request::default() };
        let tools = Tools {
            sink: &Discard::default(),
            cache: None,
            tool: crate::TOOL,
            optimiser: Some(&SpirvOpt),
            progress: &progress,
        };
        let compiled = generate::generate(sources, packages, manifest, &request, &tools)?;
        report.unique_outputs =
            Some(compiled.summary.targets.iter().map(|target| target.outputs as u64).sum());
    }
    Ok(())
}

fn print_keys(manifest: &Manifest, name: &str, json: bool) -> Result<(), Failure> {
    let program = manifest.program(name).ok_or_else(|| {
        let known = manifest.programs.iter().map(|program| program.name.as_str());
        let hint = nearest_name(name, known)
            .map_or(String::new(), |near| format!("; did you mean `{near}`?"));
        Failure::input(format!("the manifest declares no program `{name}`{hint}"))
    })?;
    let points = program.space.enumerate();
    let keys = points.iter().map(|point| program.space.key(point).to_string());
    let mut out = std::io::BufWriter::new(stdout());
    if json {
        writeln!(out, "{:#}", serde_json::json!(keys.collect::<Vec<_>>()))?;
    } else {
        for key in keys {
            writeln!(out, "{key}")?;
        }
    }
    Ok(out.flush()?)
}
