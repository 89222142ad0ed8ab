//! All permutations of a manifest, from its programs' sources to the contents of a bundle.
//!
//! Work is done once, however many permutations ask for it. An entry point composes only for
//! settings whose answers it has not seen ([`ReadTree`]), compiles only texts it has not seen,
//! and stores only bytes that are new. Units leave as they are made, so that memory holds keys and
//! hashes, and the texts of one batch.
//!
//! [`ReadTree`]: crate::permute::ReadTree

mod compile;
mod entry;
mod lint;
mod permutation;
mod shader;
mod shard;
mod sink;
mod summary;
mod trace;
mod weave;

pub use permutation::{Named, Permutation, permutation};
pub use shader::{Root, Shader};
pub use shard::Shard;
pub use sink::{Discard, Memory, Sink};
pub use summary::{EntrySummary, Judged, ProgramSummary, Summary, WholeSummary};
pub use trace::{Observer, Run, Told, Trace};

use std::collections::BTreeMap;
use std::time::Instant;

use crate::bundle::{Axis, Clip, Contents, Digest, EntryContents, ProgramContents, Target};
use crate::cache::Cache;
use crate::diagnostic::{Diagnostic, Diagnostics, codes};
use crate::link::Linker;
use crate::permute::{Assignment, Manifest, Program, Quoted, key};
use crate::resolve::Packages;
use crate::source::SourceSet;
use crate::validate::on_large_stack;
use compile::{Compiled, Compiler};
use entry::Entry;
use lint::Lints;
use summary::Outputs;
use weave::Text;

/// Diagnostics of one entry point after which no more are looked for.
const REPORTED: usize = 20;

/// What to generate of a manifest; the default is all of it.
#[derive(Debug, Clone, Default)]
pub struct Request {
    /// Only this program.
    pub program: Option<String>,
    /// Only this permutation, by its key.
    pub only: Option<Quoted>,
    /// Only these targets; those of each program where there are none.
    pub targets: Vec<Target>,
    /// Clip space of all programs, in the place of what each declares.
    pub clip: Option<Clip>,
    /// Only this part of each program's permutations.
    pub shard: Option<Shard>,
}

impl Request {
    /// The targets of a program, each once and in order.
    fn targets_of(&self, program: &Program) -> Vec<Target> {
        let chosen = if self.targets.is_empty() { &program.targets } else { &self.targets };
        let mut targets = chosen.clone();
        targets.sort();
        targets.dedup();
        targets
    }
}

/// What a run works with.
pub struct Tools<'a> {
    /// Where units go.
    pub sink: &'a dyn Sink,
    /// Where results are kept between runs, and looked up.
    pub cache: Option<&'a Cache>,
    /// Told how far the run is.
    pub progress: &'a (dyn Fn(Progress) + Sync),
}

/// How far a run is.
#[derive(Debug, Clone)]
pub struct Progress {
    /// The program and the entry point at work.
    pub stage: String,
    /// Permutations done, of how many.
    pub done: usize,
    /// Permutations of that entry point.
    pub total: usize,
}

/// Programs, keys and the account of how they came about.
#[derive(Debug)]
pub struct Generated {
    /// Keys refer to units that the sink has: the entry points themselves have none.
    pub contents: Contents,
    /// Counts and times.
    pub summary: Summary,
    /// What the author should know.
    pub warnings: Vec<Diagnostic>,
}

/// Composes, validates and emits every permutation asked for; units go to the sink as they are made.
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
    let mut outputs = Outputs::default();
    let mut lints = Lints::default();
    for (program, points, entries) in prepared(sources, packages, manifest, request)? {
        let points = request.shard.map_or(&*points, |shard| shard.of(&points));
        let targets = request.targets_of(program);
        let clip = request.clip.unwrap_or(program.clip);
        let compiler = Compiler {
            targets: &targets,
            clip,
            sink: tools.sink,
            cache: tools.cache,
            linker: Linker::for_clip(&targets, clip),
        };
        let make = |batch: &[(&Text, &Entry)]| compiler.make(batch);
        let woven = on_large_stack(|| {
            weave::weave(&entries, &program.space, points, &make, tools.progress)
        })?;
        // One permutation says nothing about the others, a part of them not enough, and none at all
        // has been told of.
        if request.only.is_none() && request.shard.is_none() && !points.is_empty() {
            lints.see(sources, program, &entries, points);
            lints.see_woven(sources, program, &entries, &woven);
        }
        outputs.add(&targets, &woven);
        generated.summary.add_reasons(&program.name, &woven);
        generated.summary.programs.push(summary::program(&program.name, points.len(), &woven));
        generated.warnings.extend(woven.iter().flat_map(|woven| woven.warnings.iter().cloned()));
        generated.contents.programs.insert(program.name.clone(), contents(program, points, &woven));
    }
    generated.warnings.extend(lints.finish());
    generated.warnings = lint::distinct(sources, generated.warnings);
    generated.summary.targets = outputs.summaries();
    generated.summary.cached = tools.cache.map_or(0, Cache::hits);
    generated.summary.seconds = start.elapsed().as_secs_f64();
    Ok(generated)
}

/// A program with its permutations and its entry points.
type Prepared<'a> = (&'a Program, Vec<Assignment>, Vec<Entry>);

/// Every program that is asked for: what is wrong with one does not hide what is wrong with another.
fn prepared<'a>(
    sources: &mut SourceSet,
    packages: &Packages,
    manifest: &'a Manifest,
    request: &Request,
) -> Result<Vec<Prepared<'a>>, Diagnostics> {
    let (mut programs, mut errors) = (Vec::new(), Diagnostics::new());
    for program in chosen(manifest, request)? {
        let points = points(program, request).map_err(|errors| {
            // A key is of one program.
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

/// [`generate`] with every unit in the contents, for callers that want the bundle in memory.
///
/// # Errors
/// As of [`generate`].
pub fn in_memory(
    sources: &mut SourceSet,
    packages: &Packages,
    manifest: &Manifest,
    request: &Request,
    progress: &(dyn Fn(Progress) + Sync),
) -> Result<Generated, Diagnostics> {
    let sink = Memory::default();
    let mut generated = generate(
        sources,
        packages,
        manifest,
        request,
        &Tools { sink: &sink, cache: None, progress },
    )?;
    sink.fill(&mut generated.contents);
    Ok(generated)
}

/// Composes every permutation asked for and compiles none: how many texts there are, and which
/// axes each entry point sees.
///
/// # Errors
/// As of [`generate`], of composing.
pub fn survey(
    sources: &mut SourceSet,
    packages: &Packages,
    program: &Program,
    progress: &(dyn Fn(Progress) + Sync),
) -> Result<ProgramSummary, Diagnostics> {
    let points = points(program, &Request::default())?;
    let entries = entry::entries(sources, packages, program, points.first())?;
    let one = || {
        Ok(Compiled {
            digest: Digest { unit: [0; 16], blobs: Box::default() },
            warnings: Vec::new(),
            whole: Vec::new(),
        })
    };
    let nothing = |batch: &[(&Text, &Entry)]| batch.iter().map(|_| one()).collect();
    let woven =
        on_large_stack(|| weave::weave(&entries, &program.space, &points, &nothing, progress))?;
    Ok(summary::program(&program.name, points.len(), &woven))
}

fn contents(program: &Program, points: &[Assignment], woven: &[weave::Woven]) -> ProgramContents {
    let axes = program.space.axes().iter().map(|axis| Axis {
        name: axis.name.clone(),
        values: axis.value_names(),
        default: axis.values[axis.default].to_string(),
        mode: axis.mode.name().to_owned(),
    });
    let mut contents = ProgramContents { axes: axes.collect(), languages: BTreeMap::new() };
    for woven in woven {
        let unit_of = woven.text_of.iter().map(|text| woven.made[*text as usize].unit);
        let keys =
            points.iter().map(|point| program.space.key(point).to_string()).zip(unit_of).collect();
        let entry = EntryContents { units: BTreeMap::new(), keys };
        contents.languages.entry(woven.language).or_default().insert(woven.label.clone(), entry);
    }
    contents
}

fn chosen<'a>(manifest: &'a Manifest, request: &Request) -> Result<Vec<&'a Program>, Diagnostics> {
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

fn points(program: &Program, request: &Request) -> Result<Vec<Assignment>, Diagnostics> {
    match &request.only {
        Some(text) => Ok(vec![asked(program, text)?]),
        None => Ok(program.space.enumerate()),
    }
}

/// The point of a key that was asked for by name: it must satisfy the constraints.
fn asked(program: &Program, text: &Quoted) -> Result<Assignment, Diagnostics> {
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
