//! `survivors.toml`: mutants that survive, each with a reason. An *equivalent* mutant gives the
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
//! [[survivor]]                              # the same keys: why no case tells it
//! ```

use std::fmt;

use super::report::MutantOutcome;
use lamplight_check::library::Library;
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};

/// Name of the file at the package's root.
const FILE: &str = "survivors.toml";

/// One entry.
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
            && self.mutation == outcome.words
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
