//! Writes diagnostics as text for people, as one line each, or as JSON. No other file knows
//! codespan-reporting.

use codespan_reporting::diagnostic as codespan;
use codespan_reporting::term;

use super::excerpt::{Excerpts, tidy_message};
use super::{Diagnostic, Severity, codes};
use crate::source::{SourceSet, Span};

/// How diagnostics are printed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Form {
    /// Excerpts with labels.
    #[default]
    Human,
    /// The same in colours, for a terminal.
    Colored,
    /// `path:line:column: error[code]: message`.
    Short,
    /// One JSON object a line.
    Json,
}

/// How many diagnostics are printed at once, since more would not help.
const SHOWN: usize = lamplight_files::limits::DIAGNOSTICS;

/// Writes diagnostics in one of the forms; the text ends with a newline.
///
/// Of those after the first hundred, only the number is printed.
pub fn render(sources: &SourceSet, diagnostics: &[Diagnostic], form: Form) -> String {
    let one = |diagnostic: &Diagnostic| match form {
        Form::Human => excerpt_form(sources, diagnostic, false),
        Form::Colored => excerpt_form(sources, diagnostic, true),
        Form::Short => short_form(sources, diagnostic) + "\n",
        Form::Json => json_form(sources, diagnostic).to_string() + "\n",
    };
    let shown = diagnostics.iter().take(SHOWN).map(one);
    shown.chain(count_of_rest(diagnostics).map(|diagnostic| one(&diagnostic))).collect()
}

fn count_of_rest(diagnostics: &[Diagnostic]) -> Option<Diagnostic> {
    let hidden = diagnostics.get(SHOWN..).filter(|hidden| !hidden.is_empty())?;
    let severity = hidden.iter().map(|diagnostic| diagnostic.severity).min()?;
    Some(Diagnostic {
        severity,
        ..Diagnostic::error(codes::NOT_SHOWN, format!("{} more are not shown", hidden.len()))
    })
}

fn excerpt_form(sources: &SourceSet, diagnostic: &Diagnostic, is_colored: bool) -> String {
    let spans: Vec<Span> = diagnostic.labels.iter().map(|label| label.span).collect();
    let excerpts = Excerpts::new(sources, &spans);
    let (found, config) = (to_codespan(diagnostic, &excerpts), term::Config::default());
    let mut text = String::new();
    let written = if is_colored {
        let styles = term::Styles::default();
        let mut ansi = term::termcolor::Ansi::new(Vec::new());
        let mut writer = term::StylesWriter::new(&mut ansi, &styles);
        let written = term::emit_to_write_style(&mut writer, &config, &excerpts, &found);
        text = String::from_utf8_lossy(ansi.get_ref()).into_owned();
        written
    } else {
        term::emit_to_string(&mut text, &config, &excerpts, &found)
    };
    // Writing to memory fails only for spans outside of the files. Then the short form is used.
    written.map_or_else(|_| short_form(sources, diagnostic) + "\n", |()| text)
}

fn to_codespan(diagnostic: &Diagnostic, excerpts: &Excerpts<'_>) -> codespan::Diagnostic<usize> {
    let labels = diagnostic.labels.iter().enumerate().map(|(index, label)| {
        let style = if index == 0 {
            codespan::LabelStyle::Primary
        } else {
            codespan::LabelStyle::Secondary
        };
        codespan::Label::new(style, label.span.source.0 as usize, excerpts.range(label.span))
            .with_message(tidy_message(&label.message))
    });
    codespan::Diagnostic::new(match diagnostic.severity {
        Severity::Error => codespan::Severity::Error,
        Severity::Warning => codespan::Severity::Warning,
    })
    .with_code(diagnostic.code.name)
    .with_message(tidy_message(&diagnostic.message))
    .with_labels(labels.collect())
    .with_notes(diagnostic.notes.iter().map(|note| tidy_message(note)).collect())
}

fn short_form(sources: &SourceSet, diagnostic: &Diagnostic) -> String {
    let place = diagnostic.labels.first().map_or(String::new(), |label| {
        let (line, column) = sources.position(label.span.source, label.span.start as usize);
        format!("{}:{line}:{column}: ", sources.get(label.span.source).path)
    });
    let help = diagnostic.notes.iter().find_map(|note| note.strip_prefix("help: "));
    let help = help.map_or(String::new(), |help| format!(" ({})", help.replace('\n', " ")));
    tidy_message(&format!(
        "{place}{}[{}]: {}{help}",
        severity_name(diagnostic.severity),
        diagnostic.code.name,
        diagnostic.message.replace('\n', " ")
    ))
}

fn json_form(sources: &SourceSet, diagnostic: &Diagnostic) -> serde_json::Value {
    let labels: Vec<_> = diagnostic
        .labels
        .iter()
        .map(|label| {
            let (line, column) = sources.position(label.span.source, label.span.start as usize);
            let (end_line, end_column) =
                sources.position(label.span.source, label.span.end as usize);
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
