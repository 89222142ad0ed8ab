//! Diagnostics as text for people, one line each, or JSON. Alone in knowing codespan-reporting.

use codespan_reporting::diagnostic as codespan;
use codespan_reporting::files::SimpleFiles;
use codespan_reporting::term;

use super::{Diagnostic, Severity};
use crate::source::SourceSet;

/// How diagnostics are printed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Form {
    /// Excerpts with labels.
    #[default]
    Human,
    /// `path:line:column: error[code]: message`.
    Short,
    /// One JSON object a line.
    Json,
}

/// The diagnostics in one of the forms, without colour, ending in a newline.
pub fn render(sources: &SourceSet, diagnostics: &[Diagnostic], form: Form) -> String {
    match form {
        Form::Human => human(sources, diagnostics),
        Form::Short => diagnostics.iter().map(|diagnostic| short(sources, diagnostic) + "\n").collect(),
        Form::Json => diagnostics.iter().map(|diagnostic| json(sources, diagnostic).to_string() + "\n").collect(),
    }
}

fn human(sources: &SourceSet, diagnostics: &[Diagnostic]) -> String {
    let mut files = SimpleFiles::new();
    for (_, source) in sources.iter() {
        files.add(source.path.clone(), source.text.to_string());
    }
    let mut text = String::new();
    for diagnostic in diagnostics {
        // Writing to a string fails only for spans outside the files; then the short form serves.
        if term::emit_to_string(&mut text, &term::Config::default(), &files, &to_codespan(diagnostic)).is_err() {
            text.push_str(&short(sources, diagnostic));
            text.push('\n');
        }
    }
    text
}

fn to_codespan(diagnostic: &Diagnostic) -> codespan::Diagnostic<usize> {
    let labels = diagnostic.labels.iter().enumerate().map(|(index, label)| {
        let style = if index == 0 { codespan::LabelStyle::Primary } else { codespan::LabelStyle::Secondary };
        codespan::Label::new(style, label.span.source.0 as usize, label.span.range()).with_message(&label.message)
    });
    codespan::Diagnostic::new(match diagnostic.severity {
        Severity::Error => codespan::Severity::Error,
        Severity::Warning => codespan::Severity::Warning,
    })
    .with_code(diagnostic.code.name)
    .with_message(&diagnostic.message)
    .with_labels(labels.collect())
    .with_notes(diagnostic.notes.clone())
}

fn short(sources: &SourceSet, diagnostic: &Diagnostic) -> String {
    let place = diagnostic.labels.first().map_or(String::new(), |label| {
        let (line, column) = sources.position(label.span.source, label.span.start as usize);
        format!("{}:{line}:{column}: ", sources.get(label.span.source).path)
    });
    format!("{place}{}[{}]: {}", severity_name(diagnostic.severity), diagnostic.code.name, diagnostic.message)
}

fn json(sources: &SourceSet, diagnostic: &Diagnostic) -> serde_json::Value {
    let labels: Vec<_> = diagnostic
        .labels
        .iter()
        .map(|label| {
            let (line, column) = sources.position(label.span.source, label.span.start as usize);
            let (end_line, end_column) = sources.position(label.span.source, label.span.end as usize);
            serde_json::json!({
                "file": sources.get(label.span.source).path,
                "line": line, "column": column, "end_line": end_line, "end_column": end_column,
                "start": label.span.start, "end": label.span.end,
                "message": label.message,
            })
        })
        .collect();
    serde_json::json!({
        "severity": severity_name(diagnostic.severity),
        "code": diagnostic.code.name,
        "message": diagnostic.message,
        "labels": labels,
        "notes": diagnostic.notes,
    })
}

fn severity_name(severity: Severity) -> &'static str {
    match severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
    }
}
