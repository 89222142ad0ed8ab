//! What to write instead of what is wrong, from the author's text around it and the types there.
//!
//! naga names types and places. The lines that help an author are found here: the value with its
//! conversion, the call with the argument that is missing.

mod compare;
pub mod convert;
mod glsl;
mod names;
mod parser;
mod stage;
mod tokens;
mod typed;

pub use compare::{OPERANDS, advise_compared};
pub use glsl::{advise_glsl, note_unknown_glsl};
pub use names::note_unknown;
pub use parser::advise_parsed;
pub use stage::{Interface, Port, Variable};
pub use typed::{Wrong, advise_typed};

use std::ops::Range;

use lamplight_rules::{Lookup, Place};

use crate::hints::last_word;

/// An error about a composed text, before its places are those of the author.
#[derive(Debug, Default)]
pub struct Mistake {
    pub message: String,
    /// The first one is the place of the error.
    pub labels: Vec<(Range<usize>, String)>,
    pub notes: Vec<String>,
}

impl Mistake {
    /// Adds what to do.
    fn help(&mut self, text: impl AsRef<str>) {
        self.notes.push(format!("help: {}", text.as_ref()));
    }

    /// Adds code to write.
    fn write(&mut self, code: impl AsRef<str>) {
        self.help(format!("write `{}`", code.as_ref()));
    }

    /// Makes a place the first one, with its own label.
    fn place(&mut self, range: Range<usize>, label: impl Into<String>) {
        self.labels.retain(|(known, _)| *known != range);
        self.labels.insert(0, (range, label.into()));
    }

    /// Says that `;` is missing at the end of what comes before a place, if a line or a block ends
    /// there: else something else is wrong.
    fn missing_semicolon(&mut self, text: &str, before: usize, at: &Range<usize>) {
        let between = text.get(before..at.start).unwrap_or_default();
        if !between.contains('\n') && text.get(at.clone()) != Some("}") {
            return;
        }
        let before = text.get(..before).unwrap_or_default();
        let start = before.rfind('\n').map_or(0, |found| found + 1);
        // A comment at the end of the line is not what lacks it.
        let code = before[start..].split("//").next().unwrap_or_default().trim_end();
        let end = start + code.len();
        let last = last_word(code).len().max(1);
        self.message = "`;` is missing".to_owned();
        self.labels = vec![(end.saturating_sub(last)..end, "after this".to_owned())];
        self.write(format!("{};", code.trim_start()));
    }

    fn start(&self) -> usize {
        self.labels.first().map_or(0, |(range, _)| range.start)
    }
}

/// A text, and its parts where it is WGSL.
struct Source<'t> {
    text: &'t str,
    lookup: Option<Lookup<'t>>,
}

impl<'t> Source<'t> {
    fn new(text: &'t str) -> Self {
        Self { text, lookup: Lookup::read(text) }
    }

    fn part(&self, place: Place) -> &'t str {
        self.text.get(place.range()).unwrap_or_default()
    }

    fn slice(&self, range: &Range<usize>) -> &'t str {
        self.text.get(range.clone()).unwrap_or_default()
    }

    /// The text with another one in a place, from `around.start` to `around.end`.
    fn replaced(&self, around: Place, place: Place, with: &str) -> String {
        let (outer, inner) = (around.range(), place.range());
        let before = self.slice(&(outer.start..inner.start.max(outer.start)));
        let after = self.slice(&(inner.end.min(outer.end)..outer.end));
        format!("{before}{with}{after}")
    }
}
