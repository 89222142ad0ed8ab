//! All permutations of a manifest, from its programs' sources to the contents of a bundle.
//!
//! Work is done once, however many permutations ask for it. An entry point composes only for
//! settings whose answers it has not seen ([`ReadTree`]), compiles only texts it has not seen,
//! and stores only bytes that are new. Units leave as they are made, so that memory holds keys and
//! hashes, and the texts of one batch.
//!
//! [`ReadTree`]: lamplight_permute::ReadTree
//!
//! # What is done once
//!
//! The cost of a permutation depends on how much of it is new. An entry point is composed only for
//! new combinations of values of the settings that it asks for. Texts are compared without comments
//! and layout, and each distinct text is compiled once. Equal bytes are stored once. No step
//! compares naga's modules, for two reasons. When this was measured, the library had 7,032 texts,
//! and no two of them gave the same output in any target; so no two of their modules were equal.
//! And printing a module in order to compare it costs a tenth of compiling it.

pub mod cache;
mod compile;
mod compositions;
mod entry;
mod lint;
mod permutation;
mod shader;
mod shard;
mod sink;
mod spirv_form;
mod stamp;
#[cfg(feature = "store")]
pub mod store;
#[cfg(not(feature = "store"))]
#[path = "store/absent.rs"]
pub mod store;
pub mod summary;
mod trace;
mod validation;

pub use permutation::{Permutation, ShaderName, permutation};
pub use shader::{CompiledShader, Root, add_numbers, entry_points, program_numbers};
pub use shard::Shard;
pub use sink::{Discard, MemorySink, Sink};
pub use spirv_form::Optimiser;
use spirv_form::SpirvShaper;
pub use stamp::Look;
pub use summary::{EntrySummary, ProgramSummary, Summary, WholeSummary};
pub use trace::{Observer, RunWarnings, Trace, TracedRun};
pub use validation::{TargetValidation, Validation};

use std::collections::BTreeMap;
use std::time::Instant;

use crate::cache::{Cache, hash_parts};
use compile::{Compiled, Compiler};
use compositions::{ComposedForms, EntryResult};
use entry::ShaderEntry;
use lamplight_bundle::contents::to_hex;
use lamplight_bundle::{
    Axis, Contents, Digest, EntryContents, ProgramContents, RequestedConventions, ShardOrigin,
    Target,
};
use lamplight_compose::resolve::Packages;
use lamplight_diagnostic::source::SourceSet;
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};
use lamplight_link::Linker;
use lamplight_permute::{Assignment, Manifest, Program, Quoted, key};
use lamplight_validate::on_large_stack;
use lint::Lints;
use summary::DistinctOutputs;

/// The most errors that are reported of the permutations of a program.
const REPORTED: usize = 20;

/// What of a manifest to generate; by default all of it.
#[derive(Debug, Clone, Default)]
pub struct Request {
    /// Only this program.
    pub program: Option<String>,
    /// Only this permutation, by its key.
    pub only: Option<Quoted>,
    /// Only these targets; each program's own targets where none are given.
    pub targets: Vec<Target>,
    /// Conventions of all programs, instead of what each declares.
    pub conventions: RequestedConventions,
    /// Only this part of each program's permutations.
    pub shard: Option<Shard>,
}

impl Request {
    /// The shaper of a program's SPIR-V.
    ///
    /// # Errors
    /// If the SPIR-V is to be optimised, and the optimiser is missing.
    fn shaper<'a>(
        &self,
        program: &Program,
        optimiser: Option<&'a dyn Optimiser>,
    ) -> Result<SpirvShaper<'a>, Diagnostics> {
        let form = self.conventions.or(program.conventions).spirv;
        SpirvShaper::new(form, &self.targets_of(program), optimiser)
    }

    /// The version of the optimiser that the run needs; `None` if it needs none.
    ///
    /// # Errors
    /// If the optimiser is missing.
    pub fn optimiser_version(
        &self,
        manifest: &Manifest,
        optimiser: Option<&dyn Optimiser>,
    ) -> Result<Option<String>, Diagnostics> {
        let is_chosen =
            |program: &&Program| self.program.as_ref().is_none_or(|wanted| *wanted == program.name);
        for program in manifest.programs.iter().filter(is_chosen) {
            if let Some(version) = self.shaper(program, optimiser)?.version() {
                return Ok(Some(version.to_owned()));
            }
        }
        Ok(None)
    }

    /// What is asked for, without the shard, and the version of the optimiser, as one line.
    fn settings(&self, optimiser: Option<&str>) -> String {
        let Self { program, only, targets, conventions, shard: _ } = self;
        let RequestedConventions { clip, source_clip, bounds, spirv } = conventions;
        let names: Vec<&str> = targets.iter().map(|target| target.name()).collect();
        let parts = [
            program.as_ref().map(|program| format!("program {program}")),
            only.as_ref().map(|only| format!("only {}", only.text)),
            (!names.is_empty()).then(|| format!("targets {}", names.join(","))),
            clip.map(|clip| format!("clip {clip:?}")),
            source_clip.map(|clip| format!("source clip {clip:?}")),
            bounds.map(|bounds| format!("bounds {bounds:?}")),
            spirv.map(|spirv| format!("spirv {spirv:?}")),
            optimiser.map(|version| format!("optimised by {version}")),
        ];
        let parts: Vec<String> = parts.into_iter().flatten().collect();
        if parts.is_empty() { "of the manifest".to_owned() } else { parts.join(", ") }
    }

    /// The targets of a program, each once and in order.
    fn targets_of(&self, program: &Program) -> Vec<Target> {
        let chosen = if self.targets.is_empty() { &program.targets } else { &self.targets };
        let mut targets = chosen.clone();
        targets.sort();
        targets.dedup();
        targets
    }
}

/// What a run uses.
pub struct Tools<'a> {
    /// Where units go.
    pub sink: &'a dyn Sink,
    /// Where results are kept between runs, and looked up.
    pub cache: Option<&'a Cache>,
    /// The identity of the program, which parts of one bundle must share. It is the same on every
    /// system that the program is built for.
    pub tool: &'a str,
    /// What optimises SPIR-V. A run that needs it and has none fails.
    pub optimiser: Option<&'a dyn Optimiser>,
    /// Called with how far the run is.
    pub progress: &'a (dyn Fn(Progress) + Sync),
}

/// How far a run is.
#[derive(Debug, Clone)]
pub struct Progress {
    /// The name of the program that is compiled now.
    pub stage: String,
    /// Permutations that are done.
    pub done: usize,
    /// Permutations of that program.
    pub total: usize,
}

/// The programs, their keys, and a summary of the run.
#[derive(Debug)]
pub struct Generated {
    /// Keys refer to units that the sink has: the entry points themselves have none.
    pub contents: Contents,
    /// Counts and times.
    pub summary: Summary,
    /// What the author should know.
    pub warnings: Vec<Diagnostic>,
}

/// Composes, validates and emits every permutation asked for; units go to the sink as they are
/// made.
///
/// # Errors
/// Diagnostics of the permutations that fail, each once, with the key of the first permutation
/// that shows it in a note.
pub fn generate(
    sources: &mut SourceSet,
    packages: &Packages,
    manifest: &Manifest,
    request: &Request,
    tools: &Tools<'_>,
) -> Result<Generated, Diagnostics> {
    let start = Instant::now();
    let mut generated = Generated {
        contents: Contents::default(),
        summary: Summary::default(),
        warnings: manifest.warnings.clone(),
    };
    let (mut outputs, mut lints) = (DistinctOutputs::default(), Lints::default());
    let optimiser = request.optimiser_version(manifest, tools.optimiser)?;
    for (program, points, entries) in prepare_programs(sources, packages, manifest, request)? {
        let points = request.shard.map_or(&*points, |shard| shard.of(&points));
        let targets = request.targets_of(program);
        let conventions = request.conventions.or(program.conventions);
        let compiler = Compiler {
            targets: &targets,
            conventions,
            sink: tools.sink,
            cache: tools.cache,
            linker: Linker::with(&targets, conventions),
            shaper: request.shaper(program, tools.optimiser)?,
        };
        let make = |batch: &[(&ComposedForms, &ShaderEntry)]| compiler.make(batch);
        let results = on_large_stack(|| {
            compositions::compose_all(&entries, &program.space, points, &make, tools.progress)
        })?;
        // Lints of unused axes and constant conditions need all permutations. A program without any
        // was warned of already.
        if request.only.is_none() && request.shard.is_none() && !points.is_empty() {
            lints.see(sources, program, &entries, points);
            lints.see_results(sources, program, &entries, &results);
        }
        outputs.add(&targets, &results);
        generated.add(program, points, &results);
    }
    let settings = request.settings(optimiser.as_deref());
    generated.contents.shard =
        request.shard.and_then(|shard| origin(shard, settings, tools.tool, sources));
    generated.warnings.extend(lints.finish());
    generated.warnings = lint::distinct(sources, generated.warnings);
    generated.summary.targets = outputs.summaries();
    generated.summary.cached = tools.cache.map_or(0, Cache::hits);
    generated.summary.seconds = start.elapsed().as_secs_f64();
    Ok(generated)
}

/// What a part of a bundle was made of; `None` for the only part.
fn origin(shard: Shard, settings: String, tool: &str, sources: &SourceSet) -> Option<ShardOrigin> {
    let (index, count) = shard.numbers();
    let texts: Vec<&str> = sources.iter().map(|(_, source)| &*source.text).collect();
    (count > 1).then(|| ShardOrigin {
        parts: [index as u64].into(),
        of: count as u64,
        tool: tool.to_owned(),
        settings,
        sources: to_hex(&hash_parts(&texts)),
    })
}

/// A program with its permutations and its entry points.
type PreparedProgram<'a> = (&'a Program, Vec<Assignment>, Vec<ShaderEntry>);

/// Every program that is asked for. Errors in the sources of one do not hide those of another.
fn prepare_programs<'a>(
    sources: &mut SourceSet,
    packages: &Packages,
    manifest: &'a Manifest,
    request: &Request,
) -> Result<Vec<PreparedProgram<'a>>, Diagnostics> {
    let (mut programs, mut errors) = (Vec::new(), Diagnostics::new());
    for program in chosen_programs(manifest, request)? {
        let points = wanted_points(program, request).map_err(|errors| {
            // A key belongs to one program.
            let help = format!("of program `{}`; `--program` names another", program.name);
            let named = manifest.programs.len() > 1 && request.program.is_none();
            errors
                .into_iter()
                .map(|error| if named { error.note(&*help) } else { error })
                .collect::<Diagnostics>()
        })?;
        match entry::entries(sources, packages, program, points.first()) {
            Ok(entries) => programs.push((program, points, entries)),
            Err(found) => errors.extend(found),
        }
    }
    if errors.is_empty() { Ok(programs) } else { Err(lint::distinct(sources, errors)) }
}

/// [`generate`] with every unit in the contents, for callers that want the bundle in memory. It runs
/// no program, so it cannot optimise SPIR-V.
///
/// # Errors
/// Those of [`generate`].
pub fn in_memory(
    sources: &mut SourceSet,
    packages: &Packages,
    manifest: &Manifest,
    request: &Request,
    progress: &(dyn Fn(Progress) + Sync),
) -> Result<Generated, Diagnostics> {
    let sink = MemorySink::default();
    let mut generated = generate(
        sources,
        packages,
        manifest,
        request,
        &Tools {
            sink: &sink,
            cache: None,
            tool: env!("CARGO_PKG_VERSION"),
            optimiser: None,
            progress,
        },
    )?;
    sink.fill(&mut generated.contents);
    Ok(generated)
}

/// Composes every permutation asked for and compiles none: returns how many texts there are, and
/// which axes each entry point asks for.
///
/// # Errors
/// Those of [`generate`] that come from composing.
pub fn survey(
    sources: &mut SourceSet,
    packages: &Packages,
    program: &Program,
    progress: &(dyn Fn(Progress) + Sync),
) -> Result<ProgramSummary, Diagnostics> {
    let points = wanted_points(program, &Request::default())?;
    let entries = entry::entries(sources, packages, program, points.first())?;
    let one =
        || Ok(Compiled { digest: Digest::default(), warnings: Vec::new(), whole: Vec::new() });
    let nothing = |batch: &[(&ComposedForms, &ShaderEntry)]| batch.iter().map(|_| one()).collect();
    let results = on_large_stack(|| {
        compositions::compose_all(&entries, &program.space, &points, &nothing, progress)
    })?;
    Ok(summary::program(&program.name, points.len(), &results))
}

impl Generated {
    fn add(&mut self, program: &Program, points: &[Assignment], results: &[EntryResult]) {
        self.summary.add_reasons(&program.name, results);
        self.summary.programs.push(summary::program(&program.name, points.len(), results));
        self.warnings.extend(results.iter().flat_map(|result| result.warnings.iter().cloned()));
        self.contents
            .programs
            .insert(program.name.clone(), program_contents(program, points, results));
    }
}

fn program_contents(
    program: &Program,
    points: &[Assignment],
    results: &[EntryResult],
) -> ProgramContents {
    let axes = program.space.axes().iter().map(|axis| Axis {
        name: axis.name.clone(),
        values: axis.value_names(),
        default: axis.values[axis.default].to_string(),
        mode: axis.mode.name().to_owned(),
    });
    let mut contents = ProgramContents { axes: axes.collect(), languages: BTreeMap::new() };
    for result in results {
        let unit_of = result.text_of.iter().map(|text| result.made[*text as usize].unit);
        let keys =
            points.iter().map(|point| program.space.key(point).to_string()).zip(unit_of).collect();
        let entry = EntryContents { units: BTreeMap::new(), keys };
        contents.languages.entry(result.language).or_default().insert(result.label.clone(), entry);
    }
    contents
}

fn chosen_programs<'a>(
    manifest: &'a Manifest,
    request: &Request,
) -> Result<Vec<&'a Program>, Diagnostics> {
    let Some(name) = &request.program else { return Ok(manifest.programs.iter().collect()) };
    let known = manifest.programs.iter().map(|program| program.name.as_str());
    manifest.program(name).map(|program| vec![program]).ok_or_else(|| {
        vec![
            Diagnostic::error(
                codes::UNKNOWN_PROGRAM,
                format!("the manifest declares no program `{name}`"),
            )
            .suggest(name, known),
        ]
    })
}

fn wanted_points(program: &Program, request: &Request) -> Result<Vec<Assignment>, Diagnostics> {
    match &request.only {
        Some(text) => Ok(vec![requested_point(program, text)?]),
        None => Ok(program.space.enumerate()),
    }
}

/// The point of a key that was asked for by name: it must satisfy the constraints.
fn requested_point(program: &Program, text: &Quoted) -> Result<Assignment, Diagnostics> {
    let point = key::parse(&program.space, text)?;
    let broken: Diagnostics = program
        .space
        .broken(&point)
        .map(|constraint| {
            let error = Diagnostic::error(
                codes::INVALID_PERMUTATION,
                format!("no permutation `{}` of program `{}`", text.text, program.name),
            );
            error.at(text.span, "asked for here").at(constraint.span, "breaks this constraint")
        })
        .collect();
    if broken.is_empty() { Ok(point) } else { Err(broken) }
}
