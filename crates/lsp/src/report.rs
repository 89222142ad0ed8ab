//! Diagnostics as editors show them.

use crate::failure::RequestError;
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use super::place::{Lines, file_address};
use lamplight_diagnostic::source::{SourceId, SourceSet};
use lamplight_diagnostic::{Diagnostic, Severity};

/// The address of a text: of a file on the disk, or of one that the library's copy has.
pub fn address_of(
    sources: &SourceSet,
    id: SourceId,
    library: &dyn Fn(&str) -> Option<PathBuf>,
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

/// A diagnostic in the protocol's form, at its first label. `None` if it has no label.
pub fn diagnostic_json(
    sources: &SourceSet,
    found: &Diagnostic,
    note: Option<&str>,
    library: &dyn Fn(&str) -> Option<PathBuf>,
) -> Option<Value> {
    let (first, others) = found.labels.split_first()?;
    let range = |span: lamplight_diagnostic::source::Span| {
        Lines::new(&sources.get(span.source).text).range(span.range())
    };
    let mut message = found.message.clone();
    if !first.message.is_empty() {
        message += &format!("\n{}", first.message);
    }
    for line in found.notes.iter().map(String::as_str).chain(note) {
        message += &format!("\n{line}");
    }
    let related = others.iter().filter_map(|label| {
        let uri = address_of(sources, label.span.source, library)?;
        let location = json!({ "uri": uri, "range": range(label.span) });
        Some(json!({ "location": location, "message": label.message }))
    });
    let unused = ["unused-import", "shadowed-import"].contains(&found.code.name);
    Some(json!({
        "range": range(first.span),
        "severity": if found.severity == Severity::Error { 1 } else { 2 },
        "code": found.code.name,
        "source": "lamplight",
        "message": message,
        "relatedInformation": related.collect::<Vec<_>>(),
        "tags": if unused { vec![1] } else { Vec::new() },
    }))
}
