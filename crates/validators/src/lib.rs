//! Judges whether the outputs in a bundle are well formed, with the judge of each target.
//!
//! `files of a bundle -> outputs -> verdict -> blame (the author's places)`; the verdict skips
//! outputs that are known to have passed before.
//!
//! Each file of `judges/` is a judge, and each target names one, so no target is without one.
//! Programs are started for batches of outputs. If a batch is refused, its halves are judged, until
//! the outputs at fault are found.

mod blame;
mod known;
mod novel;
mod tint;

use std::fmt;
use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;

pub use blame::{OutputOrigin, blame};
pub use novel::{Novelty, SeenText};
pub use tint::Tint;

use lamplight_bundle::{BlobFile, Error, Hash, Stage, Target};
use lamplight_emit::{JudgeRules, targets};
use lamplight_files::output::Scratch;
use lamplight_generate::cache::Cache;
use lamplight_tools::Tool;
use lamplight_validate::on_large_stack;

/// A judge, which a target names.
pub struct JudgeEntry {
    /// The name of its file.
    pub name: &'static str,
    /// The programs that it runs.
    pub tools: &'static [Tool],
    /// What else it needs and this machine lacks.
    pub lacks: fn(&Tint) -> Option<MissingTool>,
    /// What, beyond the versions of the programs, changes its verdicts.
    pub version: fn(&Tint) -> String,
    /// The work for a group of outputs.
    plan: JudgePlan,
}

/// Divides a group of outputs into works. The error is a message, if the judge cannot be run.
type JudgePlan = for<'w> fn(&OutputGroup<'w>) -> Result<Vec<JudgeWork<'w>>, String>;

/// Outputs of one target, stage and name of the entry point, and what judges them.
struct OutputGroup<'w> {
    outputs: &'w [&'w Output],
    /// The rules that the target names. The judge's file explains them.
    rules: &'static [&'static str],
    /// Without Tint, WGSL is judged by naga alone.
    tint: Option<&'w Tint>,
    /// Where texts are written that are not the outputs themselves.
    scratch: &'w Scratch,
}

/// One file for each judge.
pub mod judges {
    use super::JudgeEntry;
    include!(concat!(env!("OUT_DIR"), "/judges.rs"));

    /// The judge of that name.
    pub fn find(name: &str) -> Option<&'static JudgeEntry> {
        ALL.iter().copied().find(|entry| entry.name == name)
    }
}

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
        let bytes = lamplight_files::input::read_file(&self.file, u64::MAX)
            .map_err(|error| said(&error))?;
        String::from_utf8(bytes).map_err(|error| said(&error))
    }
}

/// The outputs in the files of a bundle.
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
pub struct MissingTool {
    /// What it is.
    pub what: String,
    /// The command that installs it.
    pub install: String,
}

impl fmt::Display for MissingTool {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} is not installed; install it with: {}", self.what, self.install)
    }
}

/// The judge of a target, and the rules that the target names for it.
fn judge_of(target: Target) -> Option<(&'static JudgeEntry, JudgeRules)> {
    let judged = targets::find(target)?.judged;
    judges::find(judged.judge).map(|judge| (judge, judged))
}

/// What the judges of some targets need and this machine lacks, each once.
pub fn missing(targets: &[Target], tint: &Tint) -> Vec<MissingTool> {
    let one = |target: &Target| {
        let (judge, _) = judge_of(*target)?;
        let absent = judge.tools.iter().find(|tool| tool.path().is_none());
        let absent = absent.map(|tool| MissingTool {
            what: format!("`{}`", tool.program),
            install: format!("apt-get install {}", tool.package),
        });
        absent.or_else(|| (judge.lacks)(tint))
    };
    let mut found: Vec<MissingTool> = targets.iter().filter_map(one).collect();
    found.sort();
    found.dedup();
    found
}

/// The versions of a target's judges. Outputs are judged again when they change.
fn judge_versions(target: Target, tint: &Tint) -> String {
    let Some((judge, judged)) = judge_of(target) else { return String::new() };
    let programs: String = judge.tools.iter().map(|tool| tool.version()).collect();
    format!("{} {:?} {programs} {}", judged.judge, judged.rules, (judge.version)(tint))
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

/// Called with the number of judgements that are done and the number of all.
pub type JudgeProgress<'a> = &'a (dyn Fn(usize, usize) + Sync);

/// Judges the outputs that are not known to pass, on all cores. Those that pass are remembered in
/// the cache by their content, and by the versions of their judges.
///
/// # Errors
/// A message, if a judge cannot be run.
pub fn verdict(
    mut outputs: Vec<Output>,
    cache: Option<&Cache>,
    tint: &Tint,
    progress: JudgeProgress<'_>,
) -> Result<Verdict, String> {
    outputs.sort();
    outputs.dedup_by(|one, other| (&one.file, &one.target) == (&other.file, &other.target));
    let mut verdict = Verdict::default();
    let mut new: Vec<Output> = Vec::new();
    let mut passed = Vec::new();
    for alike in outputs.chunk_by(|one, other| one.target == other.target) {
        let target = alike[0].target;
        let mut known = known::KnownOutputs::load(cache, target, &judge_versions(target, tint));
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
struct JudgeWork<'w> {
    outputs: usize,
    run: Box<dyn Fn() -> JudgeResult + Send + Sync + 'w>,
}

/// Refusals, or why a judge could not be run.
type JudgeResult = Result<Vec<Refusal>, String>;

/// Judges every output. Without Tint, WGSL is judged by naga alone.
///
/// # Errors
/// A message, if a judge cannot be run.
pub fn judge(outputs: &[Output], tint: Option<&Tint>, progress: JudgeProgress<'_>) -> JudgeResult {
    let mut sorted: Vec<&Output> = outputs.iter().collect();
    sorted.sort();
    let scratch = Scratch::new(&std::env::temp_dir()).map_err(|error| error.to_string())?;
    let alike = |one: &&Output, other: &&Output| {
        (one.target, one.stage, &one.entry) == (other.target, other.stage, &other.entry)
    };
    let groups: Vec<&[&Output]> = sorted.chunk_by(alike).collect();
    on_large_stack(|| {
        let planned = groups.par_iter().map(|group| plan_group(group, tint, &scratch));
        let works = planned.collect::<Result<Vec<Vec<JudgeWork<'_>>>, String>>()?;
        let works: Vec<JudgeWork<'_>> = works.into_iter().flatten().collect();
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
    outputs: &'w [&'w Output],
    tint: Option<&'w Tint>,
    scratch: &'w Scratch,
) -> Result<Vec<JudgeWork<'w>>, String> {
    let Some(first) = outputs.first() else { return Ok(Vec::new()) };
    let found = judge_of(first.target);
    let (judge, judged) = found.ok_or_else(|| format!("no judge of `{}`", first.target))?;
    (judge.plan)(&OutputGroup { outputs, rules: judged.rules, tint, scratch })
}

/// Divides a group into works of at most `size` outputs each, which call `run`.
fn divide_group<'w>(
    group: &'w [&'w Output],
    size: usize,
    run: impl Fn(&[&Output]) -> JudgeResult + Clone + Send + Sync + 'w,
) -> Vec<JudgeWork<'w>> {
    let part = |part: &'w [&'w Output]| {
        let run = run.clone();
        JudgeWork { outputs: part.len(), run: Box::new(move || run(part)) }
    };
    group.chunks(size).map(part).collect()
}
