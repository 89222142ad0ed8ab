//! Diagnostics with places in the form that editors need.

use lamplight::diagnostic::render::{Form, render};
use lamplight::diagnostic::{self, Diagnostics, Severity};
use lamplight::source::{SourceSet, Span};
use serde::Serialize;
use tsify::Tsify;

/// What is wrong, and where.
#[derive(Serialize, Tsify)]
#[serde(rename_all = "camelCase")]
pub struct Diagnostic {
    /// `error` or `warning`.
    pub severity: String,
    /// Short name, as `lamplight explain` takes it.
    pub code: String,
    pub message: String,
    /// The first label is the place of the mistake.
    pub labels: Vec<Label>,
    pub notes: Vec<String>,
    /// As the command line prints it, with excerpts.
    pub text: String,
}

/// A range of a file, with a few words about it.
#[derive(Serialize, Tsify)]
#[serde(rename_all = "camelCase")]
pub struct Label {
    pub path: String,
    pub message: String,
    pub from: Position,
    pub to: Position,
}

/// A place in a text.
#[derive(Serialize, Tsify)]
#[serde(rename_all = "camelCase")]
pub struct Position {
    /// From 1.
    pub line: u32,
    /// In characters, from 1.
    pub column: u32,
    /// UTF-16 units from the start of the text, as editors count.
    pub offset: u32,
}

/// All diagnostics, in their order.
pub fn diagnostics(sources: &SourceSet, found: &Diagnostics) -> Vec<Diagnostic> {
    found.iter().map(|one| diagnostic_of(sources, one)).collect()
}

fn diagnostic_of(sources: &SourceSet, found: &diagnostic::Diagnostic) -> Diagnostic {
    let label = |label: &diagnostic::Label| Label {
        path: sources.get(label.span.source).path.clone(),
        message: label.message.clone(),
        from: position(sources, label.span, label.span.start),
        to: position(sources, label.span, label.span.end),
    };
    let severity = if found.severity == Severity::Error { "error" } else { "warning" };
    Diagnostic {
        severity: severity.to_owned(),
        code: found.code.name.to_owned(),
        message: found.message.clone(),
        labels: found.labels.iter().map(label).collect(),
        notes: found.notes.clone(),
        text: render(sources, std::slice::from_ref(found), Form::Human),
    }
}

fn position(sources: &SourceSet, span: Span, byte: u32) -> Position {
    let (line, column) = sources.position(span.source, byte as usize);
    let text = &sources.get(span.source).text;
    let before = text.get(..byte as usize).unwrap_or(text);
    let offset = before.encode_utf16().count() as u32;
    Position { line: line as u32, column: column as u32, offset }
}
