//! Diagnostics as editors show them.

use crate::failure::RequestError;
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::Path;

use serde_json::{Value, json};

use super::place::Lines;
use super::places::Places;
use lamplight_diagnostic::source::Span;
use lamplight_diagnostic::{Diagnostic, Severity};

/// The answer to a hover: words about a range of a text.
pub fn hover_json(words: &str, text: &str, range: Range<usize>) -> Value {
    json!({
        "contents": { "kind": "markdown", "value": words },
        "range": Lines::new(text).range(range),
    })
}

/// The answer to a rename: the new name at the spans of texts.
pub fn rename_json<'p, 's: 'p>(
    new: &str,
    spans: impl Iterator<Item = (&'p Places<'s>, Span)>,
) -> Result<Value, RequestError> {
    let mut edits: BTreeMap<String, Vec<Value>> = BTreeMap::new();
    for (places, span) in spans {
        let uri = places.address(span.source).ok_or_else(|| "a place has no address".to_owned())?;
        let edit = json!({ "range": places.range(span), "newText": new });
        edits.entry(uri).or_default().push(edit);
    }
    Ok(json!({ "changes": edits }))
}

/// A diagnostic in the protocol's form, at its first label.
pub fn diagnostic_json(places: &Places<'_>, found: &Diagnostic, note: Option<&str>) -> Value {
    let mut message = found.message.clone();
    let labels = found.labels.split_first();
    let place = labels.map(|(first, _)| first).filter(|first| !first.message.is_empty());
    for line in
        place.map(|first| first.message.as_str()).into_iter().chain(notes(found)).chain(note)
    {
        message += &format!("\n{line}");
    }
    let others = labels.map_or(&[][..], |(_, others)| others);
    let related = others.iter().filter_map(|label| {
        let location = places.location(label.span)?;
        Some(json!({ "location": location, "message": label.message }))
    });
    let range = labels.map(|(first, _)| places.range(first.span));
    with_code(found, range.unwrap_or_default(), &message, related.collect())
}

/// A diagnostic without a place, at the first line of the text that it is about.
pub fn unplaced_json(found: &Diagnostic, text: &str) -> Value {
    let message = std::iter::once(found.message.as_str()).chain(notes(found));
    let message: Vec<&str> = message.collect();
    with_code(found, Lines::new(text).range(first_line(text)), &message.join("\n"), Vec::new())
}

/// A diagnostic of another file as it is shown in a text that depends on the file: at the import
/// that names it, or else at the first line.
pub fn pointing_json(places: &Places<'_>, found: &Diagnostic, text: &str) -> Value {
    let (mut range, mut message, mut related) =
        (first_line(text), found.message.clone(), Vec::new());
    if let Some(label) = found.labels.first() {
        let other = places.sources.get(label.span.source);
        let line = places.line(label.span);
        let name = Path::new(&other.path).file_name().unwrap_or_default().to_string_lossy();
        message = format!("{message}\nin `{name}`, line {}", line + 1);
        range = import_of(text, Path::new(&other.path)).unwrap_or(range);
        let location = places.location(label.span);
        related.extend(
            location.map(|location| json!({ "location": location, "message": label.message })),
        );
    }
    with_code(found, Lines::new(text).range(range), &message, related)
}

fn notes(found: &Diagnostic) -> impl Iterator<Item = &str> {
    found.notes.iter().map(String::as_str)
}

fn with_code(found: &Diagnostic, range: Value, message: &str, related: Vec<Value>) -> Value {
    let unused = found.code.name == "unused-import";
    json!({
        "range": range,
        "severity": if found.severity == Severity::Error { 1 } else { 2 },
        "code": found.code.name,
        "source": "lamplight",
        "message": message,
        "relatedInformation": related,
        "tags": if unused { vec![1] } else { Vec::new() },
    })
}

/// The first line of a text.
fn first_line(text: &str) -> Range<usize> {
    0..text.find('\n').unwrap_or(text.len())
}

/// The line of a text that imports a file, by the name of the file.
fn import_of(text: &str, file: &Path) -> Option<Range<usize>> {
    let stem = file.file_stem()?.to_str()?;
    let mut start = 0;
    for line in text.split_inclusive('\n') {
        let written = line.trim_end();
        let is_import = ["import", "#include", "@if", "public"]
            .iter()
            .any(|word| written.trim_start().starts_with(word));
        let names = written.split(|c: char| c != '_' && !c.is_alphanumeric());
        if is_import && names.into_iter().any(|name| name == stem) {
            let blank = line.len() - line.trim_start().len();
            return Some(start + blank..start + written.len());
        }
        start += line.len();
    }
    None
}
