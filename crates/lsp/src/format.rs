//! Formatting of documents: whole ones, the statements that a selection touches, and the statement
//! that a typed character ends. Edits are about blanks alone, so that cursors stay.

use lamplight_diagnostic::source::SourceSet;
use lamplight_format::{Edit, Indent, Language, Options};
use lamplight_lint as lint;
use serde_json::{Value, json};

use super::actions::read_text;
use super::failure::RequestError;
use super::place::{self, Lines};
use super::{Document, LanguageServer};

/// The characters that end a statement, the first one named to editors as such.
pub const TYPED: [&str; 3] = ["}", ";", "\n"];

/// `textDocument/formatting`.
pub fn format_document(
    server: &mut LanguageServer,
    parameters: &Value,
) -> Result<Value, RequestError> {
    let document = server.document(parameters)?;
    let (language, options) = formatting_of(document, parameters)?;
    let edits = lamplight_format::format_edits(&document.text, language, &options);
    Ok(edits_as_json(&document.text, &edits))
}

/// `textDocument/rangeFormatting`.
pub fn format_range(
    server: &mut LanguageServer,
    parameters: &Value,
) -> Result<Value, RequestError> {
    let document = server.document(parameters)?;
    let (language, options) = formatting_of(document, parameters)?;
    let byte = |end: &str| {
        let position = parameters.get("range").and_then(|range| range.get(end));
        position.and_then(|position| place::byte_of_position(&document.text, position))
    };
    let range = byte("start").zip(byte("end")).filter(|(start, end)| start <= end);
    let (start, end) = range.ok_or(RequestError::Parameter("range"))?;
    let edits = lamplight_format::format_range(&document.text, start..end, language, &options);
    Ok(edits_as_json(&document.text, &edits))
}

/// `textDocument/onTypeFormatting`.
pub fn format_typed(
    server: &mut LanguageServer,
    parameters: &Value,
) -> Result<Value, RequestError> {
    let (document, byte) = server.requested_place(parameters)?;
    let (language, options) = formatting_of(document, parameters)?;
    let edits = lamplight_format::format_typed(&document.text, byte, language, &options);
    Ok(edits_as_json(&document.text, &edits))
}

fn edits_as_json(text: &str, edits: &[Edit]) -> Value {
    let lines = Lines::new(text);
    let one =
        |edit: &Edit| json!({ "range": lines.range(edit.range.clone()), "newText": edit.text });
    edits.iter().map(one).collect()
}

/// The language of a document, and how it is formatted: as the nearest manifest says, and for what
/// that leaves open, as the editor says.
fn formatting_of(
    document: &Document,
    parameters: &Value,
) -> Result<(Language, Options), RequestError> {
    let language = lint::language(&document.path).ok_or(RequestError::Parameter("textDocument"))?;
    let base = options_of_editor(parameters.get("options").unwrap_or(&Value::Null));
    let file = document.root.join(&document.path);
    let found = lamplight_format::options_for(&file, base, &mut SourceSet::default(), read_text);
    let wrong = |found: Vec<lamplight_diagnostic::Diagnostic>| {
        let message = found.first().map_or_else(String::new, |first| first.message.clone());
        RequestError::Refused(format!("the options of the formatter are wrong: {message}"))
    };
    Ok((language, found.map_err(wrong)?))
}

fn options_of_editor(options: &Value) -> Options {
    let usual = Options::default();
    let spaces = options.get("tabSize").and_then(Value::as_u64);
    let spaces = spaces.and_then(|size| u8::try_from(size).ok()).filter(|size| *size <= 16);
    let indent = match options.get("insertSpaces").and_then(Value::as_bool) {
        Some(false) => Indent::Tab,
        _ => spaces.map_or(usual.indent, Indent::Spaces),
    };
    let ends = options.get("insertFinalNewline").and_then(Value::as_bool);
    Options { indent, final_newline: ends.unwrap_or(usual.final_newline), ..usual }
}
