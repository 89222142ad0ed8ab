//! What became of mistakes that a function and its reference share.

use std::collections::{BTreeMap, BTreeSet};

use lamplight_check::references::Source;

use super::kind::Kind;
use super::notice::Notice;

/// The share that must be noticed of those that change a value.
pub const LEAST_SHARE: f64 = 0.95;

/// The head of a table of [`SharedReport::functions`].
pub const HEAD: &str =
    "| function | reference | noticed | by | missed | within the error | no change |
|---|---|---|---|---|---|---|";

/// One mistake: where it is, and its fate.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SharedOutcome {
    /// `lighting::spot::cone_hard`.
    pub function: String,
    /// The author's `file:line`.
    pub place: String,
    /// That line, trimmed.
    pub line: String,
    /// A description of the mistake.
    pub mistake: String,
    pub kind: Kind,
    /// What the function's reference is written from.
    pub source: Option<Source>,
    pub fate: SharedFate,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SharedFate {
    /// By stated numbers, or by a law.
    Noticed(Notice),
    Missed,
    /// `survivors.toml` says that it changes no value.
    Equivalent,
    /// It changes no value of any input of the cases by more than the case allows.
    WithinError,
}

/// All mistakes, in the order of modules, functions and text.
#[derive(Debug, Default)]
pub struct SharedReport {
    pub outcomes: Vec<SharedOutcome>,
}

/// How many mistakes ended in each way.
#[derive(Debug, Default, Clone, PartialEq, Eq)]
pub struct Counts {
    pub noticed: BTreeMap<Notice, usize>,
    pub missed: usize,
    pub equivalent: usize,
    pub within: usize,
}

impl Counts {
    fn of<'o>(outcomes: impl IntoIterator<Item = &'o SharedOutcome>) -> Self {
        let mut counts = Self::default();
        for outcome in outcomes {
            match outcome.fate {
                SharedFate::Noticed(notice) => *counts.noticed.entry(notice).or_default() += 1,
                SharedFate::Missed => counts.missed += 1,
                SharedFate::Equivalent => counts.equivalent += 1,
                SharedFate::WithinError => counts.within += 1,
            }
        }
        counts
    }

    /// How many were noticed, and how many change a value.
    pub fn noticed(&self) -> (usize, usize) {
        let noticed = self.noticed.values().sum();
        (noticed, noticed + self.missed)
    }

    /// The cells of a table: noticed of those that change a value, by what, missed, within the error, equal.
    fn cells(&self) -> String {
        let by = |(notice, count): (&Notice, &usize)| format!("`{notice}` {count}");
        let by = self.noticed.iter().map(by).collect::<Vec<_>>().join(", ");
        let Self { noticed: _, missed, equivalent, within } = self;
        let (noticed, all) = self.noticed();
        format!("{noticed} of {all} | {by} | {missed} | {within} | {equivalent}")
    }
}

impl SharedReport {
    pub fn counts(&self) -> Counts {
        Counts::of(&self.outcomes)
    }

    /// Whether enough of them were noticed.
    pub fn passed(&self) -> bool {
        let (noticed, all) = self.counts().noticed();
        noticed as f64 >= LEAST_SHARE * all as f64
    }

    /// One line for each mistake that nothing notices.
    pub fn missed(&self) -> String {
        let missed = self.outcomes.iter().filter(|outcome| outcome.fate == SharedFate::Missed);
        missed.map(|one| format!("{}: {}: {}\n", one.place, one.function, one.mistake)).collect()
    }

    /// A row of a table for each function: what its reference is written from, and the counts.
    pub fn functions(&self) -> Vec<(&str, String)> {
        let groups = self.outcomes.chunk_by(|one, other| one.function == other.function);
        let row = |group: &'_ [SharedOutcome]| {
            let counts = Counts::of(group);
            let source = group[0].source.map_or("", Source::name);
            format!("| `{}` | {source} | {} |", group[0].function, counts.cells())
        };
        groups.map(|group| (group[0].function.as_str(), row(group))).collect()
    }

    /// A row of a table for each kind of mistake and of reference.
    pub fn kinds(&self) -> Vec<String> {
        let sources: BTreeSet<Option<Source>> =
            self.outcomes.iter().map(|outcome| outcome.source).collect();
        let row = |kind: Kind, source: Option<Source>| {
            let is_it = |one: &&SharedOutcome| one.kind == kind && one.source == source;
            let counts = Counts::of(self.outcomes.iter().filter(is_it));
            let (_, all) = counts.noticed();
            let name = source.map_or("none", Source::name);
            (all > 0).then(|| format!("| {} | {name} | {} |", kind.name(), counts.cells()))
        };
        let each = |kind: Kind| sources.iter().filter_map(move |source| row(kind, *source));
        Kind::ALL.into_iter().flat_map(each).collect()
    }

    /// A line of a list for each mistake with this fate: the function, the mistake, and the line.
    pub fn list(&self, fate: SharedFate) -> String {
        let meant = self.outcomes.iter().filter(|outcome| outcome.fate == fate);
        let line = |one: &SharedOutcome| format!("- `{}`: {}\n", one.function, one.mistake);
        meant.map(line).collect()
    }

    /// The last line of the report.
    pub fn summary(&self) -> String {
        let (noticed, all) = self.counts().noticed();
        format!("noticed {noticed} of {all} shared mistakes")
    }
}
