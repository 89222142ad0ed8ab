//! Edits of blanks, and line ends. All other code knows `\n` as the only line break.

use std::borrow::Cow;
use std::ops::Range;

use lamplight_bundle::Language;
use lamplight_syntax::wesl::blank::is_blank;

use crate::options::{LineEnds, Options};
use crate::token::split_tokens;

/// A range of bytes, and what stands there instead.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Edit {
    /// The bytes that are replaced.
    pub range: Range<usize>,
    /// What replaces them.
    pub text: String,
}

/// A text with edits, which are in order and do not overlap.
pub fn apply_edits(text: &str, edits: &[Edit]) -> String {
    let mut edited = String::with_capacity(text.len());
    let mut at = 0;
    for edit in edits {
        edited += &text[at..edit.range.start];
        edited += &edit.text;
        at = edit.range.end;
    }
    edited + &text[at..]
}

/// The text with `\n` for each of its line breaks.
pub fn unix_lines(text: &str) -> Cow<'_, str> {
    match text.contains('\r') {
        true => Cow::Owned(text.replace("\r\n", "\n").replace('\r', "\n")),
        false => Cow::Borrowed(text),
    }
}

/// The byte of an author's text that a byte of its [`unix_lines`] comes from.
pub fn byte_of_author(text: &str, byte: usize) -> usize {
    let mut moved = byte;
    for (at, _) in text.match_indices("\r\n") {
        if at >= moved {
            break;
        }
        moved += 1;
    }
    moved
}

/// The byte of [`unix_lines`] for a byte of the author's text.
pub fn byte_of_lines(text: &str, byte: usize) -> usize {
    byte - text.match_indices("\r\n").take_while(|(at, _)| *at < byte).count()
}

/// The text with the line ends that the options ask for. `author` is the text before formatting.
pub fn with_line_ends(text: String, author: &str, options: &Options) -> String {
    let end = match options.line_ends {
        LineEnds::Keep => usual_end(author),
        LineEnds::Unix => "\n",
        LineEnds::Windows => "\r\n",
    };
    if end == "\n" { text } else { text.replace('\n', end) }
}

/// What most lines of a text end with.
fn usual_end(text: &str) -> &'static str {
    let windows = text.matches("\r\n").count();
    let unix = text.matches('\n').count() - windows;
    let old = text.matches('\r').count() - windows;
    match (windows > unix, old > unix && old > windows) {
        (_, true) => "\r",
        (true, false) => "\r\n",
        (false, false) => "\n",
    }
}

/// The edits of blanks that make a text of another one. They have the same letters otherwise.
pub fn blank_edits(old: &str, new: &str) -> Vec<Edit> {
    let mut edits = Vec::new();
    let (mut from, mut to) = (0, 0);
    while from < old.len() || to < new.len() {
        let (old_end, new_end) = (blank_end(old, from), blank_end(new, to));
        let (before, after) = (&old[from..old_end], &new[to..new_end]);
        if before != after {
            edits.push(small_edit(from, before, after));
        }
        let same = same_length(&old[old_end..], &new[new_end..]);
        if same == 0 {
            debug_assert!(old_end == old.len() && new_end == new.len(), "only blanks change");
            break;
        }
        (from, to) = (old_end + same, new_end + same);
    }
    edits
}

/// Bytes of the letters that two texts begin with, up to the first blank of either.
fn same_length(old: &str, new: &str) -> usize {
    let pairs = old.chars().zip(new.chars());
    let same = pairs.take_while(|(one, other)| one == other && !is_blank(*one));
    same.map(|(letter, _)| letter.len_utf8()).sum()
}

/// An edit without the lines that both have at the start: a cursor in an empty line stays there.
fn small_edit(from: usize, before: &str, after: &str) -> Edit {
    let same = before.bytes().zip(after.bytes()).take_while(|(one, other)| one == other).count();
    let same = if before.is_char_boundary(same) && after.is_char_boundary(same) { same } else { 0 };
    Edit { range: from + same..from + before.len(), text: after[same..].to_owned() }
}

fn blank_end(text: &str, start: usize) -> usize {
    text[start..].find(|letter| !is_blank(letter)).map_or(text.len(), |length| start + length)
}

/// The first token of a text that another text does not have in its place, by its bytes.
pub fn changed_token(old: &str, new: &str, language: Language) -> Option<(u32, u32)> {
    let (before, after) = (split_tokens(old, language), split_tokens(new, language));
    let words =
        |text: &str| text.split(is_blank).filter(|word| !word.is_empty()).collect::<String>();
    for (index, token) in before.iter().enumerate() {
        let text = token.text(old);
        let is_same = after.get(index).is_some_and(|other| {
            let new = other.text(new);
            other.kind == token.kind
                && (new == text || (token.is_comment() && words(new) == words(text)))
        });
        if !is_same {
            return Some((token.start, token.end));
        }
    }
    let end = old.len() as u32;
    (after.len() > before.len()).then_some((end, end))
}
