//! A formatter for WESL and GLSL.
//!
//! Only blanks change: tokens and comments stay, in their order. A text goes through four steps:
//!
//! 1. `token` splits it into tokens; comments and lines of the preprocessor are tokens too.
//! 2. `pair` finds the partner of each bracket. An item whose brackets do not match becomes one
//!    token, which stays as it is.
//! 3. `build` makes a layout: the places where a line may end, must end, or has a space.
//! 4. `print` decides which lines end, by the width.
//!
//! Line breaks of the author are kept where a line may end: behind an opening bracket, a comma or
//! `=`, and beside an operator. All others are chosen here. A second run changes nothing: where a
//! line was too long, its breaks are the author's the next time.

#![warn(missing_docs)]

mod build;
mod edit;
mod op;
mod options;
mod pair;
mod print;
mod space;
mod token;

pub use edit::{Edit, apply_edits};
pub use lamplight_bundle::Language;
pub use options::{Braces, Indent, LineEnds, Margin, Options, TABLE, options_for, read_options};

use std::ops::Range;

use lamplight_diagnostic::source::{SourceId, Span};
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};

use build::Layout;
use pair::{Paired, Trouble, Unpaired};
use token::Token;

/// A formatted text.
#[derive(Debug)]
pub struct Formatted {
    /// The text.
    pub text: String,
    /// A diagnostic for each item that stays as it was, since its brackets do not match.
    pub diagnostics: Diagnostics,
}

/// Formats a text. `source` is the text for the places of diagnostics.
pub fn format_text(
    text: &str,
    source: SourceId,
    language: Language,
    options: &Options,
) -> Formatted {
    let lines = edit::unix_lines(text);
    let laid = lay_out(&lines, language, options);
    let place = |start: u32, end: u32| {
        let byte = |at: u32| edit::byte_of_author(text, at as usize);
        Span::new(source, byte(start)..byte(end))
    };
    let mut diagnostics: Diagnostics =
        laid.unpaired.iter().map(|one| kept_item(one, place(one.start, one.end))).collect();
    let text = match laid.formatted {
        Ok(formatted) => edit::with_line_ends(formatted, text, options),
        Err((start, end)) => {
            let message = "a token would change: the text stays as it is";
            let error = Diagnostic::error(codes::NOT_FORMATTED, message);
            diagnostics.push(error.at(place(start, end), "this token"));
            text.to_owned()
        }
    };
    Formatted { text, diagnostics }
}

/// The edits that format a text. Each is about blanks alone.
pub fn format_edits(text: &str, language: Language, options: &Options) -> Vec<Edit> {
    let lines = edit::unix_lines(text);
    match lay_out(&lines, language, options).formatted {
        Ok(formatted) => edit::blank_edits(text, &edit::with_line_ends(formatted, text, options)),
        Err(_) => Vec::new(),
    }
}

/// The edits that format the statements that a range of bytes touches, and no others. A range
/// within a block touches statements of this block only.
pub fn format_range(
    text: &str,
    range: Range<usize>,
    language: Language,
    options: &Options,
) -> Vec<Edit> {
    let touched = |laid: &Laid| {
        let start = edit::byte_of_lines(text, range.start);
        laid.touched_statements(start..edit::byte_of_lines(text, range.end))
    };
    edits_within(text, language, options, touched)
}

/// The edits that format the statement that ends before a byte: what was typed there ended it.
pub fn format_typed(text: &str, byte: usize, language: Language, options: &Options) -> Vec<Edit> {
    let ended = |laid: &Laid| laid.ended_statement(edit::byte_of_lines(text, byte));
    edits_within(text, language, options, ended)
}

fn edits_within(
    text: &str,
    language: Language,
    options: &Options,
    choose: impl FnOnce(&Laid) -> Option<Range<usize>>,
) -> Vec<Edit> {
    let lines = edit::unix_lines(text);
    let mut laid = lay_out(&lines, language, options);
    let chosen = choose(&laid);
    let formatted = std::mem::replace(&mut laid.formatted, Ok(String::new()));
    let (Some(chosen), Ok(formatted)) = (chosen, formatted) else { return Vec::new() };
    let start = edit::byte_of_author(text, chosen.start);
    let end = edit::byte_of_author(text, chosen.end);
    let formatted = edit::with_line_ends(formatted, text, options);
    let mut edits = edit::blank_edits(text, &formatted);
    edits.retain(|edit| edit.range.end >= start && edit.range.end <= end);
    edits
}

/// A text with its layout. Bytes are those of the text with `\n` as its only line break.
struct Laid {
    tokens: Vec<Token>,
    unpaired: Vec<Unpaired>,
    layout: Layout,
    /// The formatted text, or the token that would change.
    formatted: Result<String, (u32, u32)>,
}

fn lay_out(text: &str, language: Language, options: &Options) -> Laid {
    let Paired { tokens, unpaired } =
        pair::pair_brackets(text, token::split_tokens(text, language), language);
    let layout = build::build_layout(text, &tokens, language, options);
    let mut formatted = String::with_capacity(text.len() + text.len() / 8);
    if text.starts_with('\u{feff}') {
        formatted.push('\u{feff}');
    }
    print::print_layout(text, &tokens, &layout.ops, options, &mut formatted);
    if !formatted.is_empty() && (options.final_newline || text.ends_with('\n')) {
        formatted.push('\n');
    }
    let formatted = match edit::changed_token(text, &formatted, language) {
        None => Ok(formatted),
        Some(place) => Err(place),
    };
    Laid { tokens, unpaired, layout, formatted }
}

impl Laid {
    /// The bytes of statements that a range touches.
    fn touched_statements(&self, range: Range<usize>) -> Option<Range<usize>> {
        let byte = |index: usize| self.tokens.get(index).map(|token| token.start as usize);
        let contains = |block: &&Range<usize>| {
            let start = self.tokens[block.start - 1].end as usize;
            start <= range.start && byte(block.end).is_some_and(|end| range.end <= end)
        };
        let block = self.layout.blocks.iter().filter(contains).min_by_key(|block| block.len());
        let block = block.cloned().unwrap_or(0..self.tokens.len());
        let is_touched = |statement: &&Range<usize>| {
            let bytes = self.bytes_of(statement);
            block.start <= statement.start
                && statement.end <= block.end
                && bytes.start <= range.end
                && range.start <= bytes.end
        };
        let touched: Vec<Range<usize>> = self
            .layout
            .statements
            .iter()
            .filter(is_touched)
            .map(|statement| self.bytes_of(statement))
            .collect();
        let start = touched.iter().map(|bytes| bytes.start).min()?;
        Some(start..touched.iter().map(|bytes| bytes.end).max()?)
    }

    /// The bytes of the largest statement whose last token is the last one before a byte.
    fn ended_statement(&self, byte: usize) -> Option<Range<usize>> {
        let end = self.tokens.partition_point(|token| token.end as usize <= byte);
        let ended = self.layout.statements.iter().filter(|statement| statement.end == end);
        ended.max_by_key(|statement| statement.len()).map(|found| self.bytes_of(found))
    }

    fn bytes_of(&self, statement: &Range<usize>) -> Range<usize> {
        let last = &self.tokens[statement.end - 1];
        self.tokens[statement.start].start as usize..last.end as usize
    }
}

/// The error about an item that stays as it is.
fn kept_item(unpaired: &Unpaired, span: Span) -> Diagnostic {
    let (message, label) = match unpaired.trouble {
        Trouble::Open => ("a bracket is never closed", "opened here"),
        Trouble::Closer => ("a bracket closes nothing", "no bracket of this kind is open here"),
        Trouble::Deep => ("brackets nest too deep", "the first one too deep"),
    };
    Diagnostic::error(codes::NOT_FORMATTED, format!("{message}: the item stays as it is"))
        .at(span, label)
}
