//! Diagnostics as editors show them.

use crate::failure::RequestError;
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use super::place::{Lines, file_address};
use lamplight_diagnostic::source::{SourceId, SourceSet, Span};
use lamplight_diagnostic::{Diagnostic, Severity};

/// Where a file of the embedded library lies on the disk.
pub type LibraryAddress<'l> = &'l dyn Fn(&str) -> Option<PathBuf>;

/// The address of a text: of a file on the disk, or of one that the library's copy has.
pub fn address_of(
    sources: &SourceSet,
    id: SourceId,
    library: LibraryAddress<'_>,
) -> Option<String> {
    let source = sources.get(id);
    if !source.on_disk {
        return Some(file_address(&library(source.path.strip_prefix("lamplight/")?)?));
    }
    let path = Path::new(&source.path);
    Some(file_address(&path.canonicalize().unwrap_or_else(|_| path.to_owned())))
}

/// The answer to a hover: words about a range of a text.
pub fn hover_json(words: &str, text: &str, range: Range<usize>) -> Value {
    json!({
        "contents": { "kind": "markdown", "value": words },
        "range": Lines::new(text).range(range),
    })
}

/// The answer to a rename: the new name at ranges of texts, each with the address of its text.
pub fn rename_json<'t>(
    new: &str,
    places: impl Iterator<Item = (Option<String>, &'t str, Range<usize>)>,
) -> Result<Value, RequestError> {
    let mut edits: BTreeMap<String, Vec<Value>> = BTreeMap::new();
    for (uri, text, range) in places {
        let edit = json!({ "range": Lines::new(text).range(range), "newText": new });
        edits
            .entry(uri.ok_or_else(|| "a place has no address".to_owned())?)
            .or_default()
            .push(edit);
    }
    Ok(json!({ "changes": edits }))
}

/// A diagnostic in the protocol's form, at its first label.
pub fn diagnostic_json(
    sources: &SourceSet,
    found: &Diagnostic,
    note: Option<&str>,
    library: LibraryAddress<'_>,
) -> Value {
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
        let location = location_json(sources, label.span, library)?;
        Some(json!({ "location": location, "message": label.message }))
    });
    let range = labels.map(|(first, _)| range_json(sources, first.span));
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
pub fn pointing_json(
    sources: &SourceSet,
    found: &Diagnostic,
    text: &str,
    library: LibraryAddress<'_>,
) -> Value {
    let (mut range, mut message, mut related) =
        (first_line(text), found.message.clone(), Vec::new());
    if let Some(label) = found.labels.first() {
        let other = sources.get(label.span.source);
        let (line, _) = Lines::new(&other.text).units(label.span.start as usize);
        let name = Path::new(&other.path).file_name().unwrap_or_default().to_string_lossy();
        message = format!("{message}\nin `{name}`, line {}", line + 1);
        range = import_of(text, Path::new(&other.path)).unwrap_or(range);
        let location = location_json(sources, label.span, library);
        related.extend(
            location.map(|location| json!({ "location": location, "message": label.message })),
        );
    }
    with_code(found, Lines::new(text).range(range), &message, related)
}

fn notes(found: &Diagnostic) -> impl Iterator<Item = &str> {
    found.notes.iter().map(String::as_str)
}

fn range_json(sources: &SourceSet, span: Span) -> Value {
    Lines::new(&sources.get(span.source).text).range(span.range())
}

fn location_json(sources: &SourceSet, span: Span, library: LibraryAddress<'_>) -> Option<Value> {
    let uri = address_of(sources, span.source, library)?;
    Some(json!({ "uri": uri, "range": range_json(sources, span) }))
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
