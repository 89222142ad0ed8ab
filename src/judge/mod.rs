//! Judges whether the outputs in a bundle are well formed, with the judge of each target.
//!
//! `files of a bundle -> outputs -> verdict (those that passed before are known) -> blame (the author's places)`
//!
//! Each target names its judge in the table of targets, so no target is without one. Programs are
//! started for batches of outputs. If a batch is refused, its outputs are judged again one by one.

mod blame;
mod glslang;
mod known;
mod msl;
mod novel;
mod spirv;
mod tint;
mod wgsl;

use std::fmt;
use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;

pub use blame::{Made, blame};
pub use tint::Tint;

use crate::bundle::{BlobFile, Error, Hash, Stage, Target};
use crate::cache::Cache;
use crate::emit::{Judge, targets};
use crate::output::Scratch;
use crate::tools::{CLANG, GLSLANG, NODE, SPIRV_VAL, Tool};
use crate::validate::on_large_stack;

/// One output of a bundle.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Output {
    /// Its target.
    pub target: Target,
    /// Stage of its entry point.
    pub stage: Stage,
    /// Name of the entry point in the output.
    pub entry: String,
    /// Where it is.
    pub file: PathBuf,
    /// A unit of the bundle that has it.
    pub unit: Hash,
}

impl Output {
    /// A name for its content, so that an output which passed once is not judged again.
    fn name(&self) -> String {
        self.file.file_name().unwrap_or_default().to_string_lossy().into_owned()
    }

    fn text(&self) -> Result<String, String> {
        let said = |error: &dyn fmt::Display| format!("`{}`: {error}", self.file.display());
        let bytes = crate::input::read_file(&self.file, u64::MAX).map_err(|error| said(&error))?;
        String::from_utf8(bytes).map_err(|error| said(&error))
    }
}

/// The outputs that a bundle's files are.
///
/// # Errors
/// Where a file is of a target that this build does not know.
pub fn outputs(files: impl IntoIterator<Item = BlobFile>) -> Result<Vec<Output>, Error> {
    let one = |file: BlobFile| {
        let target = Target::find(&file.target).ok_or_else(|| Error::NotFound {
            what: "target",
            name: file.target.clone(),
            known: Target::ALL.iter().map(|target| target.name().to_owned()).collect(),
        })?;
        let BlobFile { stage, entry, path, unit, .. } = file;
        Ok(Output { target, stage, entry, file: path, unit })
    };
    files.into_iter().map(one).collect()
}

/// An output that its judge refuses.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Refusal {
    /// The output.
    pub output: Output,
    /// The judge that refuses it.
    pub judge: &'static str,
    /// The first line at fault, if the judge gives a line.
    pub line: Option<u32>,
    /// The judge's message.
    pub words: String,
}

/// Something that a judge needs and the machine lacks.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Missing {
    /// What it is.
    pub what: String,
    /// The command that installs it.
    pub install: String,
}

impl fmt::Display for Missing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} is not installed; install it with: {}", self.what, self.install)
    }
}

/// The programs that a judge needs.
fn judge_tools(judge: Judge) -> &'static [Tool] {
    match judge {
        Judge::SpirvVal(_) => &[SPIRV_VAL],
        Judge::Glslang(_) | Judge::GlslangHlsl => &[GLSLANG],
        Judge::Clang => &[CLANG],
        Judge::NagaAndTint => &[NODE],
    }
}

fn judge_of(target: Target) -> Option<Judge> {
    targets::find(target).map(|entry| entry.judge)
}

/// What the judges of some targets need and this machine lacks, each once.
pub fn missing(targets: &[Target], tint: &Tint) -> Vec<Missing> {
    let one = |target: &Target| {
        let judge = judge_of(*target)?;
        let absent = judge_tools(judge).iter().find(|tool| tool.path().is_none());
        let absent = absent.map(|tool| Missing {
            what: format!("`{}`", tool.program),
            install: format!("apt-get install {}", tool.package),
        });
        absent.or_else(|| matches!(judge, Judge::NagaAndTint).then(|| tint.missing()).flatten())
    };
    let mut found: Vec<Missing> = targets.iter().filter_map(one).collect();
    found.sort();
    found.dedup();
    found
}

/// The versions of a target's judges. Outputs are judged again when they change.
fn judge_versions(target: Target, tint: &Tint) -> String {
    let Some(judge) = judge_of(target) else { return String::new() };
    let programs: String = judge_tools(judge).iter().map(|tool| tool.version()).collect();
    let own = match judge {
        Judge::NagaAndTint => format!("naga {} tint {}", env!("LAMPLIGHT_NAGA"), tint.version()),
        Judge::Clang => crate::metal::shim_hash(),
        Judge::SpirvVal(_) | Judge::Glslang(_) | Judge::GlslangHlsl => String::new(),
    };
    format!("{judge:?} {programs} {own}")
}

/// The result of judging outputs.
#[derive(Debug, Default)]
pub struct Verdict {
    /// How many were judged now.
    pub judged: usize,
    /// How many passed before.
    pub known: usize,
    /// What was refused.
    pub refusals: Vec<Refusal>,
}

/// How many judgements are done, of how many.
pub type Progress<'a> = &'a (dyn Fn(usize, usize) + Sync);

/// Judges the outputs that are not known to pass, on all cores. Those that pass are remembered in
/// the cache by their content, and by the versions of their judges.
///
/// # Errors
/// A message, if a judge cannot be run.
pub fn verdict(
    mut outputs: Vec<Output>,
    cache: Option<&Cache>,
    tint: &Tint,
    progress: Progress<'_>,
) -> Result<Verdict, String> {
    outputs.sort();
    outputs.dedup_by(|one, other| (&one.file, &one.target) == (&other.file, &other.target));
    let mut verdict = Verdict::default();
    let mut new: Vec<Output> = Vec::new();
    let mut passed = Vec::new();
    for alike in outputs.chunk_by(|one, other| one.target == other.target) {
        let target = alike[0].target;
        let mut known = known::Known::load(cache, target, &judge_versions(target, tint));
        let (old, fresh): (Vec<&Output>, Vec<&Output>) =
            alike.iter().partition(|output| known.names.contains(&output.name()));
        verdict.known += old.len();
        known.names.extend(fresh.iter().map(|output| output.name()));
        new.extend(fresh.into_iter().cloned());
        passed.push(known);
    }
    verdict.judged = new.len();
    verdict.refusals = judge(&new, Some(tint), progress)?;
    for known in &mut passed {
        verdict.refusals.iter().for_each(|refusal| {
            known.names.remove(&refusal.output.name());
        });
        known.keep(cache);
    }
    Ok(verdict)
}

/// A piece of work for a judgement, and the number of outputs that it covers.
struct Work<'w> {
    outputs: usize,
    run: Box<dyn Fn() -> Found + Send + Sync + 'w>,
}

/// Refusals, or why a judge could not be run.
type Found = Result<Vec<Refusal>, String>;

/// Judges every output. Without Tint, WGSL is judged by naga alone.
///
/// # Errors
/// A message, if a judge cannot be run.
pub fn judge(outputs: &[Output], tint: Option<&Tint>, progress: Progress<'_>) -> Found {
    let mut sorted: Vec<&Output> = outputs.iter().collect();
    sorted.sort();
    let scratch = Scratch::new(&std::env::temp_dir()).map_err(|error| error.to_string())?;
    let alike = |one: &&Output, other: &&Output| {
        (one.target, one.stage, &one.entry) == (other.target, other.stage, &other.entry)
    };
    let groups: Vec<&[&Output]> = sorted.chunk_by(alike).collect();
    on_large_stack(|| {
        let planned = groups.par_iter().map(|group| plan_group(group, tint, &scratch));
        let works = planned.collect::<Result<Vec<Vec<Work<'_>>>, String>>()?;
        let works: Vec<Work<'_>> = works.into_iter().flatten().collect();
        let total = works.iter().map(|work| work.outputs).sum();
        let done = AtomicUsize::new(0);
        let found = works.par_iter().map(|work| {
            let found = (work.run)();
            progress(done.fetch_add(work.outputs, Ordering::Relaxed) + work.outputs, total);
            found
        });
        let mut refusals: Vec<Refusal> = found.collect::<Result<Vec<_>, _>>()?.concat();
        refusals.sort();
        // One refusal for an output is enough, even if it breaks several rules.
        refusals.dedup_by(|one, other| one.output == other.output);
        Ok(refusals)
    })
}

/// The work for outputs of one target, stage and name of the entry point.
fn plan_group<'w>(
    group: &'w [&'w Output],
    tint: Option<&'w Tint>,
    scratch: &'w Scratch,
) -> Result<Vec<Work<'w>>, String> {
    let Some(first) = group.first() else { return Ok(Vec::new()) };
    let judge = judge_of(first.target).ok_or_else(|| format!("no target `{}`", first.target))?;
    match judge {
        Judge::SpirvVal(environments) => Ok(spirv::plan_spirv(group, environments)),
        Judge::Glslang(rules) => glslang::plan_glsl(group, rules, scratch),
        Judge::GlslangHlsl => glslang::plan_hlsl(group),
        Judge::Clang => msl::plan_msl(group),
        Judge::NagaAndTint => Ok(wgsl::plan_wgsl(group, tint)),
    }
}

/// Divides a group into works that do the same.
fn divide_group<'w>(
    group: &'w [&'w Output],
    size: usize,
    run: impl Fn(&[&Output]) -> Found + Clone + Send + Sync + 'w,
) -> Vec<Work<'w>> {
    let part = |part: &'w [&'w Output]| {
        let run = run.clone();
        Work { outputs: part.len(), run: Box::new(move || run(part)) }
    };
    group.chunks(size).map(part).collect()
}
