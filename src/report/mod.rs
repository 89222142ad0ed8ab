//! A check's report as files: a page to look at, JSON for programs, JUnit for continuous
//! integration.
//!
//! Each is a function from the [`Report`] and its [`Origin`] to a text; the command line writes
//! them.

mod html;
mod json;
mod junit;
mod plot;

use crate::proof::check::Report;
use crate::source::{SourceSet, Span};

/// A form of a report.
pub struct Entry {
    /// File name.
    pub file: &'static str,
    pub text: fn(&Report, &Origin<'_>) -> String,
}

/// What a report is of.
pub struct Origin<'a> {
    /// The case files.
    pub sources: &'a SourceSet,
    /// The command line that made it.
    pub command: String,
}

impl Origin<'_> {
    /// File and line of a case.
    pub fn place(&self, span: Span) -> (&str, usize) {
        let (line, _) = self.sources.position(span.source, span.start as usize);
        (&self.sources.get(span.source).path, line)
    }
}

/// Every form.
pub const ALL: &[Entry] = &[
    Entry { file: "index.html", text: html::html_report },
    Entry { file: "report.json", text: json::json_report },
    Entry { file: "junit.xml", text: junit::junit_report },
];
