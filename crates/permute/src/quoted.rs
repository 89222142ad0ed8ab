//! A string from an author's text, with the place of each of its bytes, even where it has escapes.

use std::ops::Range;

use lamplight_diagnostic::source::{SourceId, SourceSet, Span};

/// Text that came out of a source, perhaps through quotes and escapes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Quoted {
    /// The text without its quotes and escapes.
    pub text: String,
    /// What stands for it in the source, quotes included.
    pub span: Span,
    /// For each byte of `text`, and for its end, the byte of the source.
    places: Vec<u32>,
}

impl Quoted {
    /// The whole text of a source, as from a command line.
    pub fn whole(sources: &SourceSet, id: SourceId) -> Self {
        let text = sources.get(id).text.to_string();
        Self { span: Span::new(id, 0..text.len()), places: (0..=text.len() as u32).collect(), text }
    }

    /// A part of a source that has no quotes and no escapes.
    pub fn plain(sources: &SourceSet, span: Span) -> Self {
        Self {
            text: sources.text(span).to_owned(),
            span,
            places: (span.start..=span.end).collect(),
        }
    }

    /// A TOML string whose literal, quotes included, covers `span` and means `text`.
    pub fn toml(sources: &SourceSet, span: Span, text: &str) -> Self {
        let places = byte_places(sources.text(span), text)
            .into_iter()
            .map(|place| span.start + place as u32)
            .collect();
        Self { text: text.to_owned(), span, places }
    }

    /// Where a range of the text stands in the source.
    pub fn span(&self, range: Range<usize>) -> Span {
        let place = |byte: usize| self.places.get(byte).map_or(self.span.end, |place| *place);
        Span { source: self.span.source, start: place(range.start), end: place(range.end) }
    }
}

/// The byte of `literal` at which each byte of `text`, and its end, is written. Both are walked
/// side by side: where `literal` does not have the next character itself, it has an escape that
/// stands for it.
fn byte_places(literal: &str, text: &str) -> Vec<usize> {
    let (start, escapes) = opening_quotes(literal);
    let mut places = Vec::with_capacity(text.len() + 1);
    let mut at = start;
    for character in text.chars() {
        at += if escapes { continuation_length(&literal[at..]) } else { 0 };
        let next = at + written_length(&literal[at..], character, escapes);
        places.extend(std::iter::repeat_n(at, character.len_utf8()));
        at = (at..=next).rev().find(|byte| literal.is_char_boundary(*byte)).unwrap_or(at);
    }
    places.push(at);
    places
}

/// The length of the opening quotes, with the newline that TOML drops, and whether the string
/// has escapes. A bare key has neither.
fn opening_quotes(literal: &str) -> (usize, bool) {
    let quote = ["\"\"\"", "'''", "\"", "'"]
        .into_iter()
        .find(|quote| literal.starts_with(quote))
        .unwrap_or("");
    let rest = &literal[quote.len()..];
    let newline = match quote.len() {
        3 if rest.starts_with("\r\n") => 2,
        3 if rest.starts_with('\n') => 1,
        _ => 0,
    };
    (quote.len() + newline, quote.starts_with('"'))
}

/// The length of line continuations: a backslash at the end of a line swallows the white space
/// up to the next character.
fn continuation_length(rest: &str) -> usize {
    let Some(after) = rest.strip_prefix('\\') else { return 0 };
    let swallowed = after.len() - after.trim_start_matches([' ', '\t', '\r', '\n']).len();
    if swallowed == 0 { 0 } else { 1 + swallowed + continuation_length(&after[swallowed..]) }
}

/// How many bytes of the literal stand for one character.
fn written_length(rest: &str, character: char, escapes: bool) -> usize {
    match rest.strip_prefix('\\').filter(|_| escapes).and_then(|after| after.chars().next()) {
        Some('x') => 4,
        Some('u') => 6,
        Some('U') => 10,
        Some(_) => 2,
        None if rest.starts_with("\r\n") && character == '\n' => 2,
        None => character.len_utf8(),
    }
}
