//! A check's report as files: a page to look at, JSON for programs, JUnit for continuous
//! integration, and a table to keep.
//!
//! Each is a function from the [`CheckReport`] and its [`ReportOrigin`] to a text; the command line
//! writes them.

mod html;
mod json;
mod junit;
mod plot;
mod table;

use std::collections::BTreeMap;

use crate::check::{CheckReport, Outcome};
use lamplight_diagnostic::source::{SourceSet, Span};

pub struct ReportForm {
    pub file: &'static str,
    pub text: fn(&CheckReport, &ReportOrigin<'_>) -> String,
}

pub struct ReportOrigin<'a> {
    /// The case files.
    pub sources: &'a SourceSet,
    /// The command line that made it.
    pub command: String,
}

impl ReportOrigin<'_> {
    /// File and line of a case.
    pub fn place(&self, span: Span) -> (&str, usize) {
        let (line, _) = self.sources.position(span.source, span.start as usize);
        (&self.sources.get(span.source).path, line)
    }
}

pub const ALL: &[ReportForm] = &[
    ReportForm { file: "index.html", text: html::html_report },
    ReportForm { file: "report.json", text: json::json_report },
    ReportForm { file: "junit.xml", text: junit::junit_report },
    ReportForm { file: "errors.md", text: table::error_table },
];

/// The executors with their adapters, in the order in which they first ran.
fn executors_of(report: &CheckReport) -> Vec<(&'static str, &str)> {
    let mut found: Vec<(&'static str, &str)> = Vec::new();
    for outcome in &report.outcomes {
        if !found.iter().any(|(executor, _)| *executor == outcome.executor) {
            found.push((outcome.executor, &outcome.adapter));
        }
    }
    found
}

/// The outcomes of each function, by its path.
fn functions_of(report: &CheckReport) -> BTreeMap<String, Vec<&Outcome>> {
    let mut found = BTreeMap::<String, Vec<&Outcome>>::new();
    for outcome in &report.outcomes {
        found.entry(outcome.path()).or_default().push(outcome);
    }
    found
}
