//! Validates the outputs in a bundle with the validator of each target.
//!
//! `files of a bundle -> outputs -> verdict -> blame (the author's places)`; the verdict skips
//! outputs that are known to have passed before. An [`Extent`] says whether it takes all others, or
//! only a selection that has each distinct line.
//!
//! Each output is also read again, by [`agreement`], and refused where it has other bindings or
//! another layout than the reflection that is shipped with it.
//!
//! Each file of `programs/` is a validator, and each target names one, so no target is without one.
//! Programs are started for batches of outputs. If a batch is refused, its halves are validated,
//! until the outputs at fault are found.

pub mod agreement;
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
use std::hash::{Hash as _, Hasher as _};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

use rayon::prelude::*;

use agreement::plan_agreement;
pub use blame::{OutputOrigin, blame};
pub use extent::Extent;
pub use novel::{Novelty, SeenText};
pub use record::BundleRecord;
pub use tint::Tint;
pub use verdict::{Verdict, verdict};

use lamplight_bundle::{BlobFile, Error, Hash, Native, Reflection, Stage, Target};
use lamplight_emit::{ValidatorRules, targets};
use lamplight_files::output::Scratch;
use lamplight_tools::Tool;
use lamplight_validate::on_large_stack;

/// A validator, which a target names.
pub struct ValidatorEntry {
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
    plan: ValidatorPlan,
}

/// Divides a group of outputs into works. The error is a message, if the validator cannot be run.
type ValidatorPlan = for<'w> fn(&OutputGroup<'w>) -> Result<Vec<ValidatorWork<'w>>, String>;

/// Outputs of one target, stage and name of the entry point, and what validates them.
struct OutputGroup<'w> {
    outputs: &'w [&'w Output],
    /// The rules that the target names. The validator's file explains them.
    rules: &'static [&'static str],
    /// Without Tint, WGSL is validated by naga alone.
    tint: Option<&'w Tint>,
    /// Where texts are written that are not the outputs themselves.
    scratch: &'w Scratch,
}

/// One file for each validator.
pub mod programs {
    use super::ValidatorEntry;
    include!(concat!(env!("OUT_DIR"), "/programs.rs"));

    /// The validator of that name.
    pub fn find(name: &str) -> Option<&'static ValidatorEntry> {
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
    /// What the bundle says of its entry point.
    pub reflection: Arc<Reflection>,
    /// What the bundle says of its entry point in this target.
    pub native: Arc<Native>,
    /// A name for what the bundle says.
    pub description: String,
}

impl Output {
    /// A name for its content and for what the bundle says of it, so that an output which passed
    /// once is not validated again.
    fn name(&self) -> String {
        let file = self.file.file_name().unwrap_or_default().to_string_lossy();
        format!("{file} {}", self.description)
    }

    fn text(&self) -> Result<String, String> {
        let text = String::from_utf8(read_bytes(&self.file)?);
        text.map_err(|error| format!("`{}`: {error}", self.file.display()))
    }
}

/// A name for what is said of an output that no bundle lists: equal for equal descriptions.
pub fn describe(reflection: &Reflection, native: &Native) -> String {
    let mut hasher = std::hash::DefaultHasher::new();
    (reflection, native).hash(&mut hasher);
    format!("{:016x}", hasher.finish())
}

/// The bytes of a file.
fn read_bytes(file: &Path) -> Result<Vec<u8>, String> {
    lamplight_files::input::read_file(file, u64::MAX)
        .map_err(|error| format!("`{}`: {error}", file.display()))
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
        let BlobFile { target: _, stage, entry, path, unit, reflection, native, description } =
            file;
        Ok(Output { target, stage, entry, file: path, unit, reflection, native, description })
    };
    files.into_iter().map(one).collect()
}

/// An output that its validator refuses.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Refusal {
    /// The output.
    pub output: Output,
    /// The validator that refuses it.
    pub validator: &'static str,
    /// The first line at fault, if the validator gives a line.
    pub line: Option<u32>,
    /// The validator's message.
    pub message: String,
}

/// Something that a validator needs and the machine lacks.
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

/// The validator of a target, and the rules that the target names for it.
fn validator_of(target: Target) -> Option<(&'static ValidatorEntry, ValidatorRules)> {
    let named = targets::find(target)?.validation;
    programs::find(named.validator).map(|validator| (validator, named))
}

/// What the validator of a target needs and this machine lacks.
pub fn missing(target: Target, tint: &Tint) -> Option<MissingTool> {
    let (validator, _) = validator_of(target)?;
    let absent = validator.tools.iter().find(|tool| tool.path().is_none());
    let absent = absent.map(|tool| MissingTool {
        what: format!("`{}`", tool.program),
        install: format!("apt-get install {}", tool.package),
    });
    absent.or_else(|| (validator.lacks)(tint))
}

/// The versions of a target's validators. Outputs are validated again when they change.
fn validator_versions(target: Target, tint: &Tint) -> String {
    let Some((validator, named)) = validator_of(target) else { return String::new() };
    let programs: String = validator.tools.iter().map(|tool| tool.version()).collect();
    format!("{} {:?} {programs} {}", named.validator, named.rules, (validator.version)(tint))
}

/// A piece of work for the validators, and the number of outputs that it covers.
struct ValidatorWork<'w> {
    outputs: usize,
    run: Box<dyn Fn() -> ValidatorResult + Send + Sync + 'w>,
}

/// Refusals, or why a validator could not be run.
type ValidatorResult = Result<Vec<Refusal>, String>;

/// Called with the number of outputs that are validated and the number of all.
pub type ValidatorProgress<'a> = &'a (dyn Fn(usize, usize) + Sync);

/// Validates every output. Without Tint, WGSL is validated by naga alone.
///
/// # Errors
/// A message, if a validator cannot be run.
pub fn validate_outputs(
    outputs: &[Output],
    tint: Option<&Tint>,
    progress: ValidatorProgress<'_>,
) -> ValidatorResult {
    let outputs: Vec<&Output> = outputs.iter().collect();
    on_large_stack(|| Ok(validate_timed(&outputs, &[], tint, progress)?.0))
}

/// Reads every output again, and refuses those that differ from their reflections. No other
/// validator is asked.
///
/// # Errors
/// A message, if a program that reads outputs cannot be run.
pub fn read_again(outputs: &[Output]) -> ValidatorResult {
    let outputs: Vec<&Output> = outputs.iter().collect();
    on_large_stack(|| Ok(validate_timed(&[], &outputs, None, &|_, _| ())?.0))
}

/// Refusals, and the seconds that each target took, added over all cores.
type TimedRefusals = (Vec<Refusal>, BTreeMap<Target, f64>);

/// [`validate_outputs`] on the threads of the caller. Those of `sample` are only read again.
fn validate_timed(
    outputs: &[&Output],
    sample: &[&Output],
    tint: Option<&Tint>,
    progress: ValidatorProgress<'_>,
) -> Result<TimedRefusals, String> {
    let mut sorted = outputs.to_vec();
    sorted.sort();
    // The validator of WGSL reads its outputs itself.
    let own = sorted.iter().filter(|output| output.target != Target::WGSL);
    let mut read: Vec<&Output> = own.chain(sample).copied().collect();
    read.sort();
    let scratch = Scratch::new(&std::env::temp_dir()).map_err(|error| error.to_string())?;
    let alike = |one: &&Output, other: &&Output| {
        (one.target, one.stage, &one.entry) == (other.target, other.stage, &other.entry)
    };
    let groups: Vec<&[&Output]> = sorted.chunk_by(alike).collect();
    let read_groups: Vec<&[&Output]> = read.chunk_by(alike).collect();
    let planned = groups.par_iter().map(|group| plan_group(group, tint, &scratch));
    let mut works = named_works(&groups, planned.collect::<Result<_, String>>()?);
    let planned = read_groups.par_iter().map(|group| plan_agreement(group));
    works.extend(named_works(&read_groups, planned.collect::<Result<_, String>>()?));
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

/// The works for groups, each with its target.
fn named_works<'w>(
    groups: &[&[&Output]],
    works: Vec<Vec<ValidatorWork<'w>>>,
) -> Vec<(Target, ValidatorWork<'w>)> {
    let named = groups.iter().zip(works).flat_map(|(group, works)| {
        let target = group.first().map(|output| output.target);
        works.into_iter().filter_map(move |work| Some((target?, work)))
    });
    named.collect()
}

/// The work for outputs of one target, stage and name of the entry point.
fn plan_group<'w>(
    outputs: &'w [&'w Output],
    tint: Option<&'w Tint>,
    scratch: &'w Scratch,
) -> Result<Vec<ValidatorWork<'w>>, String> {
    let Some(first) = outputs.first() else { return Ok(Vec::new()) };
    let found = validator_of(first.target);
    let (validator, named) = found.ok_or_else(|| format!("no validator of `{}`", first.target))?;
    (validator.plan)(&OutputGroup { outputs, rules: named.rules, tint, scratch })
}

/// Divides a group into works of at most `size` outputs each, which call `run`.
fn divide_group<'w>(
    group: &'w [&'w Output],
    size: usize,
    run: impl Fn(&[&Output]) -> ValidatorResult + Clone + Send + Sync + 'w,
) -> Vec<ValidatorWork<'w>> {
    let part = |part: &'w [&'w Output]| {
        let run = run.clone();
        ValidatorWork { outputs: part.len(), run: Box::new(move || run(part)) }
    };
    group.chunks(size).map(part).collect()
}
