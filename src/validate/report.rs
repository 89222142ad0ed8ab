//! naga's errors as diagnostics in the author's text.

use std::error::Error;
use std::ops::Range;

use naga::front::{glsl, wgsl};
use naga::valid::ValidationError;

use crate::bundle::Language;
use crate::compose::Composed;
use crate::diagnostic::{Diagnostic, Diagnostics, codes};

/// An error of the WGSL parser, with all its labels and notes.
pub fn wgsl(composed: &Composed, error: &wgsl::ParseError) -> Diagnostic {
    let mut diagnostic = Diagnostic::error(codes::WGSL_ERROR, sentence(error.message()));
    for (span, label) in error.labels() {
        diagnostic = place(diagnostic, composed, span.to_range(), label);
    }
    error.notes().fold(diagnostic, |diagnostic, note| diagnostic.note(note))
}

/// Every error of the GLSL parser.
pub fn glsl(composed: &Composed, errors: &glsl::ParseErrors) -> Diagnostics {
    errors
        .errors
        .iter()
        .map(|error| {
            let message = sentence(&error.kind.to_string());
            if message == "missing entry point" {
                return Diagnostic::error(codes::NO_ENTRY_POINT, "the file has no function `main`");
            }
            let diagnostic = Diagnostic::error(codes::GLSL_ERROR, message);
            place(diagnostic, composed, error.meta.to_range(), "here")
        })
        .collect()
}

/// An error of the validator: its chain of causes as the message, its spans as labels.
pub fn validation(composed: &Composed, error: &naga::WithSpan<ValidationError>) -> Diagnostic {
    let code = match composed.language {
        Language::Wesl => codes::WGSL_ERROR,
        Language::Glsl => codes::GLSL_ERROR,
    };
    // The shortest span says most: it becomes the diagnostic's place.
    let mut spans: Vec<_> =
        error.spans().map(|(span, context)| (span.to_range(), kind(context))).collect();
    spans.sort_by_key(|(range, _)| range.as_ref().map_or(usize::MAX, ExactSizeIterator::len));
    let diagnostic = Diagnostic::error(code, sentence(&causes(error.as_inner()).join(": ")));
    spans
        .into_iter()
        .fold(diagnostic, |diagnostic, (range, words)| place(diagnostic, composed, range, words))
}

/// A label where the range has an author, else a note that quotes the composed text.
fn place(
    diagnostic: Diagnostic,
    composed: &Composed,
    range: Option<Range<usize>>,
    label: &str,
) -> Diagnostic {
    let Some(range) = range else {
        return if label.is_empty() || label == "here" {
            diagnostic
        } else {
            diagnostic.note(label)
        };
    };
    if let Some(span) = composed.map.lookup(range.clone()) {
        return diagnostic.at(span, label);
    }
    let quoted = composed.text.get(range).and_then(|text| text.lines().next()).unwrap_or_default();
    diagnostic.note(format!("{label}: in text the composer wrote, `{quoted}`"))
}

/// The messages of an error and of its causes, outermost first, without naga's handles.
fn causes(error: &dyn Error) -> Vec<String> {
    let mut messages = Vec::new();
    let mut next = Some(error);
    while let Some(error) = next {
        messages.push(without_handles(&error.to_string()));
        next = error.source();
    }
    messages
}

/// Removes indices into naga's arenas, such as ` [12]`, which mean nothing to an author.
fn without_handles(message: &str) -> String {
    let message = message.replace("Some([", "[").replace("])", "]");
    let mut clean = String::with_capacity(message.len());
    let mut rest = message.as_str();
    while let Some(start) = rest.find(" [") {
        let digits = rest[start + 2..].bytes().take_while(u8::is_ascii_digit).count();
        let end = start + 2 + digits;
        let is_handle = digits > 0 && rest[end..].starts_with(']');
        clean.push_str(&rest[..if is_handle { start } else { start + 2 }]);
        rest = &rest[if is_handle { end + 1 } else { start + 2 }..];
    }
    clean + rest
}

/// What a span of the validator stands for; naga names the Rust type of its arena.
fn kind(context: &str) -> &str {
    const KINDS: [(&str, &str); 8] = [
        ("::GlobalVariable", "this variable"),
        ("::LocalVariable", "this variable"),
        ("::Expression", "this expression"),
        ("::Function", "this function"),
        ("::Constant", "this constant"),
        ("::Override", "this override"),
        ("::EntryPoint", "this entry point"),
        ("::Type", "this type"),
    ];
    KINDS.iter().find(|(name, _)| context.contains(name)).map_or(context, |(_, words)| words)
}

/// naga's message in our style: a lower-case start, unless a name starts it.
fn sentence(message: &str) -> String {
    let message = message.trim();
    let first_word = message.split(|c: char| !c.is_alphanumeric()).next().unwrap_or_default();
    let is_name = first_word.chars().skip(1).any(char::is_uppercase);
    match message.chars().next() {
        Some(first) if !is_name && first.is_uppercase() => {
            first.to_lowercase().chain(message.chars().skip(1)).collect()
        }
        _ => message.to_owned(),
    }
}
