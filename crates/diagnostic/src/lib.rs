//! The one error type: what is wrong, where in the author's text, and what to do about it.
//!
//! Adding a diagnostic is adding a Markdown file to `codes/`. Its name is the code, its first line
//! the title. `Page: NAME` names the page of the guide that explains it. The rest is what
//! `lamplight explain` prints.

mod escape;
mod excerpt;
pub mod guide;
mod read;
pub mod render;
pub mod source;

pub use escape::{escape_controls, escape_markup, needs_escape};

use crate::source::{SourceId, Span};

/// A kind of diagnostic, with its explanation.
#[derive(Debug, PartialEq, Eq)]
pub struct Code {
    /// Kebab-case name, as printed in brackets and taken by `lamplight explain`.
    pub name: &'static str,
    /// One line.
    pub title: &'static str,
    /// Markdown paragraphs: when it happens, an example, how to mend it.
    pub explanation: &'static str,
    /// Name of the page of the guide that explains it, without its extension.
    pub page: &'static str,
}

/// Every code, one constant for each file of `codes/`.
pub mod codes {
    use super::Code;
    include!(concat!(env!("OUT_DIR"), "/codes.rs"));

    /// The code of that name.
    pub fn find(name: &str) -> Option<&'static Code> {
        ALL.iter().copied().find(|code| code.name == name)
    }
}

/// The message about code that ended with a panic.
pub fn stopped_message(what: &str) -> String {
    format!("{what} stopped with an internal error")
}

/// How much a diagnostic weighs. Only errors fail a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// The run fails.
    Error,
    /// The run goes on.
    Warning,
}

/// A span with a few words. The first label of a diagnostic is its place.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Label {
    /// The place in the author's text.
    pub span: Span,
    /// A few words at the place.
    pub message: String,
}

/// Something the author should know.
#[derive(Debug, Clone, PartialEq, Eq)]
#[must_use]
pub struct Diagnostic {
    /// Whether it fails the run.
    pub severity: Severity,
    /// What kind it is, with an explanation.
    pub code: &'static Code,
    /// One line.
    pub message: String,
    /// Places, the main one first.
    pub labels: Vec<Label>,
    /// Lines under the excerpt.
    pub notes: Vec<String>,
    /// The name of the item that the diagnostic is about, if a caller asked for it by name. The
    /// caller knows which place to point to.
    pub item: Option<String>,
}

/// Several diagnostics: errors, warnings or both.
pub type Diagnostics = Vec<Diagnostic>;

impl Diagnostic {
    /// The same about another file with the same text.
    pub fn moved(mut self, from: SourceId, to: SourceId) -> Self {
        for label in self.labels.iter_mut().filter(|label| label.span.source == from) {
            label.span.source = to;
        }
        self
    }

    /// An error without a place yet.
    pub fn error(code: &'static Code, message: impl Into<String>) -> Self {
        Self {
            severity: Severity::Error,
            code,
            message: message.into(),
            labels: Vec::new(),
            notes: Vec::new(),
            item: None,
        }
    }

    /// A warning without a place yet.
    pub fn warning(code: &'static Code, message: impl Into<String>) -> Self {
        Self { severity: Severity::Warning, ..Self::error(code, message) }
    }

    /// Adds a labelled place. The first one is the place of the diagnostic.
    pub fn at(mut self, span: Span, message: impl Into<String>) -> Self {
        self.labels.push(Label { span, message: message.into() });
        self
    }

    /// Names the item that the diagnostic is about.
    pub fn about_item(mut self, name: impl Into<String>) -> Self {
        self.item = Some(name.into());
        self
    }

    /// Adds a note under the source excerpt.
    pub fn note(mut self, note: impl Into<String>) -> Self {
        self.notes.push(note.into());
        self
    }

    /// Adds "did you mean" with the nearest of the known names, if one is near enough.
    pub fn suggest<'a>(self, wrong: &str, known: impl IntoIterator<Item = &'a str>) -> Self {
        match nearest_name(wrong, known) {
            Some(name) => {
                let unlike = unlike_letters(wrong, name);
                let named = self.note(format!("help: did you mean `{name}`?"));
                unlike.into_iter().fold(named, Self::note)
            }
            None => self,
        }
    }
}

/// How two names differ, if that may not be seen: `é` is one letter, or an `e` and an accent.
fn unlike_letters(wrong: &str, known: &str) -> Option<String> {
    let letters = |name: &str| name.chars().collect::<Vec<char>>();
    let (wrong, known) = (letters(wrong), letters(known));
    let same = |pair: &(&char, &char)| pair.0 == pair.1;
    let start = wrong.iter().zip(&known).take_while(same).count();
    let (wrong, known) = (&wrong[start..], &known[start..]);
    let end = wrong.iter().rev().zip(known.iter().rev()).take_while(same).count();
    let (wrong, known) = (&wrong[..wrong.len() - end], &known[..known.len() - end]);
    if wrong.iter().chain(known).all(char::is_ascii) {
        return None;
    }
    let points = |letters: &[char]| {
        let all = letters.iter().map(|letter| format!("U+{:04X}", u32::from(*letter)));
        Some(all.collect::<Vec<_>>().join(" ")).filter(|text| !text.is_empty())
    };
    let nothing = || "nothing".to_owned();
    let (known, wrong) = (points(known), points(wrong));
    Some(format!(
        "it has {} where {} is written here",
        known.unwrap_or_else(nothing),
        wrong.unwrap_or_else(nothing)
    ))
}

/// Longer names are not compared: they are hardly misspelt.
const LONGEST_MISSPELT: usize = 100;

/// A conversion is often looked for by its opposite name: `a_to_b` is `b_from_a`.
fn opposite_name(name: &str) -> Option<String> {
    let named = |one: &str, other: &str| {
        name.split_once(one).map(|(left, right)| format!("{right}{other}{left}"))
    };
    named("_to_", "_from_").or_else(|| named("_from_", "_to_"))
}

/// The known name nearest to a misspelt one; ties go to the alphabetically first.
pub fn nearest_name<'a>(wrong: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let length = wrong.chars().count();
    if length > LONGEST_MISSPELT {
        return None;
    }
    let known: Vec<&str> = known.into_iter().collect();
    let converse = opposite_name(wrong);
    if let Some(same) = known.iter().find(|name| Some(**name) == converse.as_deref()) {
        return Some(same);
    }
    // A name that has no letter in common with another is not a misspelling of it.
    let allowed = (1 + length / 4).min(length.saturating_sub(1));
    known
        .into_iter()
        .filter(|name| *name != wrong && name.chars().count().abs_diff(length) <= allowed)
        .map(|name| (strsim::damerau_levenshtein(wrong, name), name))
        .filter(|(distance, _)| *distance <= allowed)
        .min()
        .map(|(_, name)| name)
}
