//! The summary of a run.

use std::collections::BTreeMap;
use std::fmt;

use serde::{Deserialize, Serialize};

use super::EntryResult;
use super::validation::Validation;
use lamplight_bundle::{Hash, Language, Target};
use lamplight_link::Reason;

/// How much there was to do, how much was done, and what came out.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Summary {
    /// In the order of the manifest.
    pub programs: Vec<ProgramSummary>,
    /// By name.
    pub targets: Vec<TargetSummary>,
    /// Texts whose results came from the cache. All others were compiled.
    pub cached: usize,
    /// The texts that were compiled as a whole, and not from functions that are each translated
    /// once.
    #[serde(default)]
    pub whole: Vec<WholeSummary>,
    /// The validators' verdicts on the outputs, if validators ran.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub validated: Option<Validation>,
    /// Whether there was nothing to do, since neither the inputs nor the bundle changed since the
    /// last run.
    pub up_to_date: bool,
    /// Time of the whole run.
    pub seconds: f64,
}

/// One program.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct ProgramSummary {
    /// Name of the program.
    pub name: String,
    /// Permutations that were asked for.
    pub permutations: usize,
    /// Its entry points.
    pub entries: Vec<EntrySummary>,
}

/// One entry point of one language.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct EntrySummary {
    /// Name of the entry point.
    pub entry: String,
    /// Language of its source.
    pub language: Language,
    /// Compositions made, of all permutations.
    pub compositions: usize,
    /// Distinct texts among them, each compiled once.
    pub unique: usize,
    /// Axes that its compositions asked for.
    pub axes: Vec<String>,
}

/// Texts of one entry point that a target compiled as a whole for one reason.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct WholeSummary {
    /// Name of the program.
    pub program: String,
    /// Name of the entry point.
    pub entry: String,
    /// Language of its source.
    pub language: Language,
    /// Name of the target.
    pub target: String,
    /// Why naga compiled the text as a whole.
    pub reason: Reason,
    /// How many texts had that reason.
    pub texts: usize,
    /// The key of the first permutation with such a text.
    pub example: String,
}

/// One target, over all programs.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct TargetSummary {
    pub target: String,
    /// Distinct outputs.
    pub outputs: usize,
    /// Their bytes.
    pub bytes: u64,
}

pub(super) fn program(name: &str, permutations: usize, results: &[EntryResult]) -> ProgramSummary {
    let entries = results.iter().map(|result| EntrySummary {
        entry: result.label.clone(),
        language: result.language,
        compositions: result.compositions,
        unique: result.made.len(),
        axes: result.reads.iter().cloned().collect(),
    });
    ProgramSummary { name: name.to_owned(), permutations, entries: entries.collect() }
}

/// The distinct outputs of each target: the length of each by its hash. [`Self::add`] takes the
/// results of one program.
#[derive(Debug, Default)]
pub(super) struct DistinctOutputs(BTreeMap<Target, BTreeMap<Hash, u32>>);

impl DistinctOutputs {
    pub fn add(&mut self, targets: &[Target], results: &[EntryResult]) {
        for digest in results.iter().flat_map(|result| &result.made) {
            for (target, found) in targets.iter().zip(&digest.targets) {
                self.0.entry(*target).or_default().insert(found.blob, found.length);
            }
        }
    }

    pub fn summaries(&self) -> Vec<TargetSummary> {
        let summary = |(target, blobs): (&Target, &BTreeMap<Hash, u32>)| TargetSummary {
            target: target.name().to_owned(),
            outputs: blobs.len(),
            bytes: blobs.values().map(|length| u64::from(*length)).sum(),
        };
        self.0.iter().map(summary).collect()
    }
}

impl Summary {
    /// Adds what a program's entry points compiled as a whole.
    pub(super) fn add_reasons(&mut self, program: &str, results: &[EntryResult]) {
        for result in results {
            let whole =
                result.whole.iter().map(|((reason, target), (texts, example))| WholeSummary {
                    program: program.to_owned(),
                    entry: result.label.clone(),
                    language: result.language,
                    target: target.name().to_owned(),
                    reason: *reason,
                    texts: *texts,
                    example: example.clone(),
                });
            self.whole.extend(whole);
        }
    }

    /// Permutations of all programs.
    pub fn permutations(&self) -> usize {
        self.programs.iter().map(|program| program.permutations).sum()
    }

    /// Distinct texts of all entry points.
    pub fn texts(&self) -> usize {
        self.programs.iter().flat_map(|program| &program.entries).map(|entry| entry.unique).sum()
    }
}

/// `1 text`, `2 texts`.
pub fn counted_words(count: usize, what: &str) -> String {
    format!("{count} {what}{}", if count == 1 { "" } else { "s" })
}

impl fmt::Display for Summary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.programs.iter().try_for_each(|program| write!(f, "{program}"))?;
        self.targets.iter().try_for_each(|target| write!(f, "{target}"))?;
        self.validated.iter().try_for_each(|validated| write!(f, "{validated}"))?;
        if self.up_to_date {
            return writeln!(
                f,
                "{} up to date, checked in {:.2} s",
                counted_words(self.permutations(), "permutation"),
                self.seconds
            );
        }
        writeln!(f, "{}: {} from the cache", counted_words(self.texts(), "text"), self.cached)?;
        self.whole.iter().try_for_each(|whole| write!(f, "{whole}"))?;
        let rate = self.permutations() as f64 / self.seconds.max(1e-9);
        writeln!(
            f,
            "{} in {:.2} s, {rate:.0} a second",
            counted_words(self.permutations(), "permutation"),
            self.seconds
        )
    }
}

impl fmt::Display for ProgramSummary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}: {}", self.name, counted_words(self.permutations, "permutation"))?;
        self.entries.iter().try_for_each(|entry| write!(f, "{entry}"))
    }
}

impl fmt::Display for EntrySummary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let language = format!("{:?}", self.language).to_lowercase();
        let axes = match self.axes.len() {
            1 => "1 axis".to_owned(),
            count => format!("{count} axes"),
        };
        writeln!(f, "  {:12} {language}  {:6} unique, {axes} seen", self.entry, self.unique)
    }
}

impl fmt::Display for WholeSummary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { entry, target, reason, texts, example, .. } = self;
        let about = reason.about();
        writeln!(f, "  {entry} {target}: {texts} compiled as a whole, such as `{example}`: {about}")
    }
}

impl fmt::Display for TargetSummary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { target, outputs, bytes } = self;
        let what = if *outputs == 1 { "output" } else { "outputs" };
        writeln!(f, "{target:8} {outputs:6} {what:7} {:8.1} MB", *bytes as f64 / 1e6)
    }
}
