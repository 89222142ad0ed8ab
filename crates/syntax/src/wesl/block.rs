//! Braces under a condition. The specification flattens them: where the condition holds, their
//! content takes the place of the whole block, without the braces and the condition.

use std::ops::Range;

use super::condition::{self, Attributes};
use super::cursor::Tokens;
use super::trivia;
use lamplight_diagnostic::{Diagnostic, codes};

/// Checks the attributes of a block: only a condition is allowed.
pub fn check_attributes(
    tokens: Tokens<'_>,
    start: usize,
    attributes: Attributes,
) -> Result<(), Diagnostic> {
    let open = attributes.end;
    let arguments = tokens.is(start + 2, b'(').then_some(start + 2);
    let first = arguments.map_or(start + 2, |open| tokens.partner(open) + 1);
    if start == open || (condition::is_conditional(tokens, start) && first == open) {
        return Ok(());
    }
    let odd = if condition::is_conditional(tokens, start) { first } else { start };
    let message = format!("a block of declarations has the attribute `@{}`", tokens.text(odd + 1));
    Err(Diagnostic::error(codes::SYNTAX_ERROR, message)
        .at(tokens.span(odd + 1), "only a condition may stand before a block"))
}

/// The warning about braces without a condition.
pub fn unreachable_braces(tokens: Tokens<'_>, open: usize) -> Diagnostic {
    let message = "a block of declarations without a condition";
    Diagnostic::warning(codes::BLOCK_READING, message)
        .at(tokens.span(open), "what is in these braces is in no permutation")
        .note("help: write `@if(...)` before it, or remove the braces")
}

/// The warning about an import that other tools do not read.
pub fn import_inside(tokens: Tokens<'_>, keyword: usize) -> Diagnostic {
    Diagnostic::warning(codes::BLOCK_READING, "an `import` in a block")
        .at(tokens.span(keyword), "other tools refuse it here")
        .note("help: write the condition before each `import` at the top of the file")
}

/// The warning about a local that is used behind the block it is declared in.
pub fn used_behind(tokens: Tokens<'_>, at: usize) -> Diagnostic {
    let message = format!("`{}` is declared in a conditional block before this", tokens.text(at));
    Diagnostic::warning(codes::BLOCK_READING, message)
        .at(tokens.span(at), "in scope here, since the braces of `@if(...) { }` are not a scope")
        .note("tools that are older than this rule end its scope at the `}`")
}

/// The text of a flattened block's head that is removed: from its first attribute to the brace, and
/// whole lines if nothing else is on them.
pub fn removed_head(tokens: Tokens<'_>, start: usize, open: usize) -> Range<u32> {
    let text = tokens.text;
    let bytes = tokens.range(start, open + 1);
    let end = trivia::trailing_end(text, bytes.end, tokens.start(open + 1));
    let start = line_start(text, bytes.start);
    match line_end(text, end) {
        Some(after) if at_line_start(text, start) => start..after,
        _ => bytes.start..trivia::skip_blank(text, end),
    }
}

/// The text that is removed with the closing brace of a flattened block: its whole line, if nothing
/// else is on it.
pub fn removed_tail(tokens: Tokens<'_>, close: usize) -> Range<u32> {
    let text = tokens.text;
    let bytes = tokens.range(close, close + 1);
    let start = line_start(text, bytes.start);
    let alone = at_line_start(text, start);
    let end = trivia::trailing_end(text, bytes.end, tokens.start(close + 1));
    match line_end(text, end) {
        Some(after) if alone => start..after,
        // `} @else {`: the line break before it is removed, and the one after it stays.
        _ if alone => start - line_break(&text[..start as usize])..bytes.end,
        _ => bytes.start - blanks_before(text, bytes.start)..bytes.end,
    }
}

/// The start of the line, if only blanks stand before the byte; else the byte itself.
pub fn line_start(text: &str, byte: u32) -> u32 {
    let start = byte - blanks_before(text, byte);
    if at_line_start(text, start) { start } else { byte }
}

fn blanks_before(text: &str, byte: u32) -> u32 {
    let head = &text[..byte as usize];
    (head.len() - head.trim_end_matches([' ', '\t']).len()) as u32
}

fn at_line_start(text: &str, byte: u32) -> bool {
    byte == 0 || text[..byte as usize].ends_with('\n')
}

/// The end of the line, if only blanks stand before that.
fn line_end(text: &str, byte: u32) -> Option<u32> {
    let rest = &text[byte as usize..];
    let blank = rest.len() - rest.trim_start_matches([' ', '\t', '\r']).len();
    rest[blank..].starts_with('\n').then(|| byte + blank as u32 + 1)
}

/// Length of the line break at the end of the text.
fn line_break(text: &str) -> u32 {
    if text.ends_with("\r\n") { 2 } else { u32::from(text.ends_with('\n')) }
}
