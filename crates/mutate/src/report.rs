//! What became of the mutants.
//!
//! `survivors.toml` lists mutants that survive, each with a reason. An *equivalent* mutant gives the
//! same values as the original for every input, and does not count. A *survivor* differs, but no
//! case notices it, and counts.
//!
//! ```toml
//! [[equivalent]]
//! function = "lighting::spot::cone_smooth"
//! line = "let t = clamp((c - outer) / (inner - outer), 0.0, 1.0);"
//! mutation = "`max` in `...`"               # as printed
//! reason = "why the value is the same"
//!
//! [[survivor]]                              # the same keys: why no case notices it
//! ```

use lamplight_check::library::Library;
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};
use std::fmt;

/// The share of the mutants that the cases must kill.
pub const LEAST_SHARE: f64 = 0.99;

/// One mutant: where its mistake is, and its fate.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MutantOutcome {
    /// `lighting::spot::cone_hard`.
    pub function: String,
    /// The author's `file:line`.
    pub place: String,
    /// That line, trimmed.
    pub line: String,
    /// A description of the mistake.
    pub mistake: String,
    pub fate: Fate,
}

/// How a mutant ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fate {
    Killed,
    Survived,
    /// No case runs the function.
    Unreached,
    /// Survived for a reason that is listed, by the index of the entry.
    Explained(usize),
    /// Listed as equal to the original, by the index of the entry.
    Equivalent(usize),
}

/// All mutants, in the order of modules, functions and text.
#[derive(Debug, Default)]
pub struct MutantReport {
    pub outcomes: Vec<MutantOutcome>,
    /// Entries of the list that match no surviving mutant.
    pub stale: Vec<String>,
    /// Reasons of the list's entries.
    reasons: Vec<String>,
}

pub fn make_report(outcomes: Vec<MutantOutcome>, listed: &[Listed]) -> MutantReport {
    let used = |index: usize| {
        outcomes.iter().any(|outcome| {
            [Fate::Equivalent(index), Fate::Explained(index)].contains(&outcome.fate)
        })
    };
    let stale = listed
        .iter()
        .enumerate()
        .filter(|(index, _)| !used(*index))
        .map(|(_, listed)| listed.to_string())
        .collect();
    MutantReport {
        outcomes,
        stale,
        reasons: listed.iter().map(|listed| listed.reason.clone()).collect(),
    }
}

impl MutantReport {
    /// How many mutants were killed, and how many count: all but those listed as equivalent.
    pub fn killed(&self) -> (usize, usize) {
        let of = |fates: fn(Fate) -> bool| {
            self.outcomes.iter().filter(|outcome| fates(outcome.fate)).count()
        };
        (of(|fate| fate == Fate::Killed), of(|fate| !matches!(fate, Fate::Equivalent(_))))
    }

    /// Whether enough of them were killed.
    pub fn passed(&self) -> bool {
        let (killed, all) = self.killed();
        killed as f64 >= LEAST_SHARE * all as f64
    }

    /// One line for each mutant that survived.
    pub fn survivors(&self) -> String {
        let through = self.outcomes.iter().filter_map(|outcome| match outcome.fate {
            Fate::Survived => Some((outcome, "")),
            Fate::Unreached => Some((outcome, "no case runs this function")),
            Fate::Explained(index) => {
                Some((outcome, self.reasons.get(index).map_or("", String::as_str)))
            }
            Fate::Killed | Fate::Equivalent(_) => None,
        });
        let line = |(outcome, why): (&MutantOutcome, &str)| {
            let why = if why.is_empty() { String::new() } else { format!(" ({why})") };
            format!("{}: {}: {}{why}\n", outcome.place, outcome.function, outcome.mistake)
        };
        through.map(line).collect()
    }

    /// Mutants that are listed as equal to the original.
    pub fn equivalent(&self) -> usize {
        self.outcomes.iter().filter(|outcome| matches!(outcome.fate, Fate::Equivalent(_))).count()
    }

    /// The last line of the report.
    pub fn summary(&self) -> String {
        let (killed, all) = self.killed();
        format!("killed {killed} of {all} mutants")
    }
}

/// Name of the file at the package's root.
const FILE: &str = "survivors.toml";

#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Listed {
    function: String,
    line: String,
    mutation: String,
    pub reason: String,
    /// Whether the mutant is equivalent, so that it does not count.
    pub equivalent: bool,
}

impl Listed {
    /// Whether the entry is about this mutant.
    pub fn is(&self, outcome: &MutantOutcome) -> bool {
        self.function == outcome.function
            && self.line == outcome.line
            && self.mutation == outcome.mistake
    }
}

impl fmt::Display for Listed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {} (in `{}`)", self.function, self.mutation, self.line)
    }
}

/// The entries of the package's list; none if there is no file.
pub fn read_list(library: &Library) -> Result<Vec<Listed>, Diagnostics> {
    let Some(text) = library.text(FILE) else { return Ok(Vec::new()) };
    let invalid =
        |message: String| vec![Diagnostic::error(codes::CASE_SYNTAX, format!("{FILE}: {message}"))];
    let table: toml::Table =
        text.parse().map_err(|error: toml::de::Error| invalid(error.message().to_owned()))?;
    let entries =
        |key: &str| table.get(key).and_then(toml::Value::as_array).map_or(&[][..], Vec::as_slice);
    let kinds = [("equivalent", true), ("survivor", false)];
    kinds
        .iter()
        .flat_map(|(key, equivalent)| {
            entries(key).iter().map(|entry| read_entry(entry, *equivalent).map_err(invalid))
        })
        .collect()
}

fn read_entry(entry: &toml::Value, equivalent: bool) -> Result<Listed, String> {
    let text = |key: &str| match entry.get(key).and_then(toml::Value::as_str) {
        Some(text) if !text.is_empty() => Ok(text.to_owned()),
        _ => Err(format!("an entry has no `{key}`: {entry}")),
    };
    Ok(Listed {
        function: text("function")?,
        line: text("line")?,
        mutation: text("mutation")?,
        reason: text("reason")?,
        equivalent,
    })
}
