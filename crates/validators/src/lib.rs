//! Judges whether the outputs in a bundle are well formed, with the judge of each target.
//!
//! `files of a bundle -> outputs -> verdict -> blame (the author's places)`; the verdict skips
//! outputs that are known to have passed before. An [`Extent`] says whether it takes all others, or
//! only a selection that has each distinct line.
//!
//! Each file of `judges/` is a judge, and each target names one, so no target is without one.
//! Programs are started for batches of outputs. If a batch is refused, its halves are judged, until
//! the outputs at fault are found.

mod blame;
mod extent;
mod known;
mod lines;
mod novel;
mod record;
mod tint;
mod verdict;

use std::collections::BTreeMap;
use std::fmt;
use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

use rayon::prelude::*;

pub use blame::{OutputOrigin, blame};
pub use extent::Extent;
pub use novel::{Novelty, SeenText};
pub use record::BundleRecord;
pub use tint::Tint;
pub use verdict::{Verdict, verdict};

use lamplight_bundle::{BlobFile, Error, Hash, Stage, Target};
use lamplight_emit::{JudgeRules, targets};
use lamplight_files::output::Scratch;
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
    /// The validators that it asks for some rules on this machine, each with its version.
    pub validators: fn(&[&str], &Tint) -> Vec<String>,
    /// Whether it says something although one of its tools is missing.
    pub goes_on: bool,
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

/// What the judge of a target needs and this machine lacks.
pub fn missing(target: Target, tint: &Tint) -> Option<MissingTool> {
    let (judge, _) = judge_of(target)?;
    let absent = judge.tools.iter().find(|tool| tool.path().is_none());
    let absent = absent.map(|tool| MissingTool {
        what: format!("`{}`", tool.program),
        install: format!("apt-get install {}", tool.package),
    });
    absent.or_else(|| (judge.lacks)(tint))
}

/// The versions of a target's judges. Outputs are judged again when they change.
fn judge_versions(target: Target, tint: &Tint) -> String {
    let Some((judge, judged)) = judge_of(target) else { return String::new() };
    let programs: String = judge.tools.iter().map(|tool| tool.version()).collect();
    format!("{} {:?} {programs} {}", judged.judge, judged.rules, (judge.version)(tint))
}

/// A piece of work for a judgement, and the number of outputs that it covers.
struct JudgeWork<'w> {
    outputs: usize,
    run: Box<dyn Fn() -> JudgeResult + Send + Sync + 'w>,
}

/// Refusals, or why a judge could not be run.
type JudgeResult = Result<Vec<Refusal>, String>;

/// Called with the number of judgements that are done and the number of all.
pub type JudgeProgress<'a> = &'a (dyn Fn(usize, usize) + Sync);

/// Judges every output. Without Tint, WGSL is judged by naga alone.
///
/// # Errors
/// A message, if a judge cannot be run.
pub fn judge(outputs: &[Output], tint: Option<&Tint>, progress: JudgeProgress<'_>) -> JudgeResult {
    let outputs: Vec<&Output> = outputs.iter().collect();
    on_large_stack(|| Ok(judge_timed(&outputs, tint, progress)?.0))
}

/// Refusals, and the seconds that each target took, added over all cores.
type TimedRefusals = (Vec<Refusal>, BTreeMap<Target, f64>);

/// [`judge`] on the threads of the caller.
fn judge_timed(
    outputs: &[&Output],
    tint: Option<&Tint>,
    progress: JudgeProgress<'_>,
) -> Result<TimedRefusals, String> {
    let mut sorted = outputs.to_vec();
    sorted.sort();
    let scratch = Scratch::new(&std::env::temp_dir()).map_err(|error| error.to_string())?;
    let alike = |one: &&Output, other: &&Output| {
        (one.target, one.stage, &one.entry) == (other.target, other.stage, &other.entry)
    };
    let groups: Vec<&[&Output]> = sorted.chunk_by(alike).collect();
    let planned = groups.par_iter().map(|group| {
        let works = plan_group(group, tint, &scratch)?;
        Ok(works.into_iter().map(|work| (group[0].target, work)).collect())
    });
    let works = planned.collect::<Result<Vec<Vec<(Target, JudgeWork<'_>)>>, String>>()?;
    let works: Vec<(Target, JudgeWork<'_>)> = works.into_iter().flatten().collect();
    let total = works.iter().map(|(_, work)| work.outputs).sum();
    let done = AtomicUsize::new(0);
    let found = works.par_iter().map(|(target, work)| {
        let start = Instant::now();
        let found = (work.run)()?;
        progress(done.fetch_add(work.outputs, Ordering::Relaxed) + work.outputs, total);
        Ok((*target, start.elapsed().as_secs_f64(), found))
    });
    let (mut refusals, mut seconds) = (Vec::new(), BTreeMap::new());
    for (target, took, found) in found.collect::<Result<Vec<_>, String>>()? {
        *seconds.entry(target).or_default() += took;
        refusals.extend(found);
    }
    refusals.sort();
    // One refusal for an output is enough, even if it breaks several rules.
    refusals.dedup_by(|one, other| one.output == other.output);
    Ok((refusals, seconds))
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
