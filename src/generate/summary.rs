//! The account of a run.

use std::collections::BTreeMap;
use std::fmt;
use std::time::Duration;

use serde::Serialize;

use super::weave::Woven;
use crate::bundle::{Contents, Language};

/// How much there was to do, how much was done, and what came out.
#[derive(Debug, Clone, Serialize)]
pub struct Summary {
    pub programs: Vec<ProgramSummary>,
    pub targets: Vec<TargetSummary>,
    pub seconds: f64,
}

/// One program.
#[derive(Debug, Clone, Serialize)]
pub struct ProgramSummary {
    pub name: String,
    pub permutations: usize,
    pub entries: Vec<EntrySummary>,
}

/// One entry point of one language.
#[derive(Debug, Clone, Serialize)]
pub struct EntrySummary {
    pub entry: String,
    pub language: Language,
    /// Compositions made, of all permutations.
    pub compositions: usize,
    /// Distinct texts among them, each compiled once.
    pub unique: usize,
    /// Axes that the stage can see.
    pub axes: Vec<String>,
}

/// One target, over all programs.
#[derive(Debug, Clone, Default, Serialize)]
pub struct TargetSummary {
    pub target: String,
    /// Distinct outputs.
    pub outputs: usize,
    /// Their bytes.
    pub bytes: usize,
}

pub(super) fn program(name: &str, permutations: usize, woven: &[Woven]) -> ProgramSummary {
    let entries = woven.iter().map(|woven| EntrySummary {
        entry: woven.label.clone(),
        language: woven.language.into(),
        compositions: woven.compositions,
        unique: woven.units.len(),
        axes: woven.reads.iter().cloned().collect(),
    });
    ProgramSummary { name: name.to_owned(), permutations, entries: entries.collect() }
}

pub(super) fn summarise(programs: Vec<ProgramSummary>, contents: &Contents, elapsed: Duration) -> Summary {
    Summary { programs, targets: targets(contents), seconds: elapsed.as_secs_f64() }
}

fn targets(contents: &Contents) -> Vec<TargetSummary> {
    let mut outputs: BTreeMap<&str, BTreeMap<&[u8], ()>> = BTreeMap::new();
    let entries = contents.programs.values().flat_map(|program| program.languages.values()).flat_map(BTreeMap::values);
    for (target, artifact) in entries.flat_map(|entry| entry.units.values()).flat_map(|unit| &unit.targets) {
        outputs.entry(target).or_default().insert(&artifact.bytes, ());
    }
    let summary = |(target, blobs): (&str, BTreeMap<&[u8], ()>)| TargetSummary {
        target: target.to_owned(),
        outputs: blobs.len(),
        bytes: blobs.keys().map(|bytes| bytes.len()).sum(),
    };
    outputs.into_iter().map(summary).collect()
}

impl Summary {
    /// Permutations of all programs.
    pub fn permutations(&self) -> usize {
        self.programs.iter().map(|program| program.permutations).sum()
    }
}

impl fmt::Display for Summary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for program in &self.programs {
            writeln!(f, "{}: {} permutations", program.name, program.permutations)?;
            for entry in &program.entries {
                let language = format!("{:?}", entry.language).to_lowercase();
                writeln!(f, "  {:12} {language}  {:6} unique, {} axes seen", entry.entry, entry.unique, entry.axes.len())?;
            }
        }
        for target in &self.targets {
            writeln!(f, "{:8} {:6} outputs {:8.1} MB", target.target, target.outputs, target.bytes as f64 / 1e6)?;
        }
        let rate = self.permutations() as f64 / self.seconds.max(1e-9);
        writeln!(f, "{} permutations in {:.2} s, {rate:.0} a second", self.permutations(), self.seconds)
    }
}
