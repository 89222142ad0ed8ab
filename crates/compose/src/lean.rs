//! Removes comments and layout from a text: the same program in a third of the bytes.
//!
//! naga ignores comments and layout. So the outputs of a lean text are those of the whole text;
//! only naga's spans differ, and no output holds spans. Texts that differ in comments or layout
//! alone are compiled once, and an edited comment does not cause any compilation.
//!
//! Type aliases are replaced by what they stand for. naga makes a type of its own for an alias, so
//! in Metal an array and its alias would be two types.

use std::borrow::Cow;
use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{PoisonError, RwLock};

use rustc_hash::FxHashMap;

use super::{Composed, Part, PartKind, SourceMap};
use lamplight_bundle::Language;
use lamplight_syntax::wesl::blank::{comment_length, is_blank};

/// How deeply aliases may refer to each other. Deeper ones are kept, so that naga reports them.
const ALIAS_DEPTH: usize = 64;

/// How many bytes longer a part may get by the expansion of its aliases. If it gets longer than
/// that, its aliases are kept.
const ALIAS_BYTES: usize = 1 << 16;

/// If the remembered parts and their lean forms have more bytes than this, all are forgotten.
const REMEMBERED_BYTES: usize = 16 << 20;

/// The text to compile. It has no map to the author's files: to get errors with places, validate
/// the whole text.
pub fn lean(composed: &Composed) -> Composed {
    Leaner::new(composed.language).lean(composed)
}

/// Makes the lean texts of one language. It remembers the lean form of each part, since the
/// permutations of a program share most of their parts. A form depends on its part alone, so no
/// text depends on what is remembered.
pub struct Leaner {
    language: Language,
    /// The lean form of each part.
    known: RwLock<FxHashMap<Box<str>, Box<str>>>,
    /// Bytes of all known parts.
    bytes: AtomicUsize,
}

impl Leaner {
    /// A leaner that remembers nothing yet.
    pub fn new(language: Language) -> Self {
        Self { language, known: RwLock::default(), bytes: AtomicUsize::new(0) }
    }

    /// The lean form of a text; see [`lean`].
    pub fn lean(&self, composed: &Composed) -> Composed {
        let mut text = String::with_capacity(composed.text.len() / 2);
        let mut parts = Vec::with_capacity(composed.parts.len());
        if composed.parts.is_empty() {
            append_lean(self.language, &composed.text, &mut text);
        }
        let mut new: Vec<(Cow<'_, str>, Range<usize>)> = Vec::new();
        let known = self.known.read().unwrap_or_else(PoisonError::into_inner);
        for part in &composed.parts {
            let start = text.len();
            if let Some(whole) = without_aliases(composed, part) {
                match known.get(&*whole) {
                    Some(lean) => text.push_str(lean),
                    None => {
                        append_lean(self.language, &whole, &mut text);
                        new.push((whole, start..text.len()));
                    }
                }
            }
            let (range, names) = (start..text.len(), part.names.clone());
            let (uses, aliases) = (part.uses.clone(), Vec::new());
            parts.push(Part { kind: part.kind, names, range, uses, aliases });
            if text.len() > start && !text.ends_with('\n') {
                text.push('\n');
            }
        }
        drop(known);
        self.remember(new, &text);
        Composed {
            text,
            map: SourceMap::default(),
            parts,
            reads: Vec::new(),
            warnings: Vec::new(),
            decisions: Vec::new(),
            ..*composed
        }
    }

    /// Remembers the lean forms of parts, which are ranges of a text.
    fn remember(&self, new: Vec<(Cow<'_, str>, Range<usize>)>, text: &str) {
        if new.is_empty() {
            return;
        }
        let more: usize = new.iter().map(|(whole, range)| whole.len() + range.len()).sum();
        let mut known = self.known.write().unwrap_or_else(PoisonError::into_inner);
        if self.bytes.fetch_add(more, Ordering::Relaxed) + more > REMEMBERED_BYTES {
            known.clear();
            self.bytes.store(more, Ordering::Relaxed);
        }
        known.extend(new.into_iter().map(|(whole, range)| (whole.into(), text[range].into())));
    }
}

/// The text of a part in which aliases are replaced by what they stand for; `None` for the
/// declaration of an alias, unless it could not be expanded.
fn without_aliases<'c>(composed: &'c Composed, part: &Part) -> Option<Cow<'c, str>> {
    let author = Cow::Borrowed(&composed.text[part.range.clone()]);
    let whole = match part.aliases.is_empty() {
        true => Some(author.clone()),
        false => expand_aliases(composed, part).map(Cow::Owned),
    };
    match whole {
        Some(_) if part.kind == PartKind::Alias => None,
        Some(whole) => Some(whole),
        None => Some(author),
    }
}

/// Appends a part, or a text without parts, without its comments and layout.
fn append_lean(language: Language, text: &str, lean: &mut String) {
    match language {
        Language::Wesl => append_wgsl(text, lean),
        Language::Glsl if has_odd_lines(text) => lean.push_str(text),
        Language::Glsl => append_glsl(text, lean),
    }
}

/// Whether lines must stay as they are: a backslash continues a line or a comment, a line ends with
/// a carriage return alone, or the text asks for its line's number.
fn has_odd_lines(text: &str) -> bool {
    text.contains('\\') || text.contains('\r') || text.contains("__LINE__")
}

/// A part with its aliases expanded; `None` where that is not possible.
fn expand_aliases(composed: &Composed, part: &Part) -> Option<String> {
    let mut text = String::new();
    append_expanded(composed, part, part.range.clone(), ALIAS_DEPTH, &mut text)?;
    Some(text)
}

/// Appends a range of a part, in which each alias is replaced by its type.
fn append_expanded(
    composed: &Composed,
    part: &Part,
    range: Range<usize>,
    depth: usize,
    text: &mut String,
) -> Option<()> {
    let mut at = range.start;
    let within = |used: &Range<usize>| used.start >= range.start && used.end <= range.end;
    for (used, alias) in part.aliases.iter().filter(|(used, _)| within(used)) {
        text.push_str(composed.text.get(at..used.start)?);
        let alias = composed.parts.get(*alias as usize)?;
        let declaration = &composed.text[alias.range.clone()];
        let name = alias.names.first()?;
        let equals = alias.range.start + alias_type_start(declaration, name)?;
        let end = alias.range.start + declaration.rfind(';')?;
        // A blank on both sides, since the bracket that ends a type must not touch a `=` or `>`.
        text.push(' ');
        append_expanded(composed, alias, equals..end, depth.checked_sub(1)?, text)?;
        text.push(' ');
        if text.len() > part.range.len() + ALIAS_BYTES {
            return None;
        }
        at = used.end;
    }
    text.push_str(composed.text.get(at..range.end)?);
    Some(())
}

/// Where the type begins in the declaration of an alias: after the `=` behind its name.
fn alias_type_start(declaration: &str, name: &str) -> Option<usize> {
    let squeezed = lean_wgsl(declaration);
    // A comment may have a `=` too. Each one is tried, and the right one has the type behind it.
    let (_, target) = squeezed.split_once('=')?;
    let plain = squeezed.strip_prefix("alias ")?.trim_start().strip_prefix(name)?;
    let ends = declaration.rfind(';')?;
    let is_plain = plain.trim_start().starts_with('=');
    let places = declaration.match_indices('=').map(|(at, _)| at + 1);
    let mut fitting = places.filter(|at| {
        *at <= ends && format!("{};", lean_wgsl(&declaration[*at..ends])).trim() == target.trim()
    });
    fitting.next().filter(|_| is_plain)
}

/// WGSL without comments and layout. It has no strings: `//` and `/*` always begin a comment, and
/// block comments nest.
pub fn lean_wgsl(text: &str) -> String {
    let mut lean = String::with_capacity(text.len());
    append_wgsl(text, &mut lean);
    lean
}

fn append_wgsl(text: &str, lean: &mut String) {
    let mut at = 0;
    while at < text.len() {
        let rest = &text[at..];
        let gap = gap_length(rest);
        if gap > 0 && gap < rest.len() {
            write_part(lean, &rest[gap..]);
        }
        let token = token_length(&rest[gap..]);
        lean.push_str(&rest[gap..gap + token]);
        at += gap + token;
    }
}

/// Writes `next`, after a blank where the two could become one token.
fn write_part(lean: &mut String, next: &str) {
    let alone = |found: Option<&u8>| found.is_none_or(|byte| stands_alone(*byte));
    if !alone(lean.as_bytes().last()) && !alone(next.as_bytes().first()) {
        lean.push(' ');
    }
}

/// Length of the text up to the first blank or comment.
fn token_length(text: &str) -> usize {
    let bytes = text.as_bytes();
    let mut at = 0;
    while let Some(&byte) = bytes.get(at) {
        at += match byte {
            b'/' if comment_length(&text[at..]) > 0 => return at,
            b'!'..=b'~' => 1,
            _ => match text[at..].chars().next() {
                Some(found) if !is_blank(found) => found.len_utf8(),
                _ => return at,
            },
        };
    }
    at
}

/// Length of the blanks and comments at the start of the text.
fn gap_length(text: &str) -> usize {
    let bytes = text.as_bytes();
    let mut at = 0;
    while let Some(&byte) = bytes.get(at) {
        at += match byte {
            // Nearly all blanks are one of these two.
            b' ' | b'\n' => 1,
            b'!'..=b'.' | b'0'..=b'~' => return at,
            _ => match (comment_length(&text[at..]), text[at..].chars().next()) {
                (0, Some(found)) if is_blank(found) => found.len_utf8(),
                (0, _) => return at,
                (length, _) => length,
            },
        };
    }
    at
}

/// Whether the character can never become part of a longer token.
fn stands_alone(found: u8) -> bool {
    matches!(found, b'\n' | b'(' | b')' | b'[' | b']' | b'{' | b'}' | b',' | b';')
}

/// GLSL without comments and layout. Directives end with their line, so lines stay; block comments
/// do not nest.
pub fn lean_glsl(text: &str) -> String {
    let mut lean = String::with_capacity(text.len());
    append_glsl(text, &mut lean);
    lean
}

/// Byte by byte, since iterators are slow without optimisation, and a dev build of the crate is not
/// optimised.
fn append_glsl(text: &str, lean: &mut String) {
    let bytes = text.as_bytes();
    let (mut at, mut line) = (0, LineState::Empty);
    while at < bytes.len() {
        match bytes[at] {
            b'\n' => {
                at += 1;
                line.end(lean);
            }
            b' ' | b'\t' | b'\r' | b'\x0c' => at += 1,
            b'/' if glsl_comment_length(&text[at..]) > 0 => at += glsl_comment_length(&text[at..]),
            _ => {
                let end = glsl_word_end(text, at);
                line.add(&text[at..end], lean);
                at = end;
            }
        }
    }
    line.end(lean);
}

/// What a line of lean GLSL has so far.
enum LineState {
    Empty,
    Code,
    Directive,
}

impl LineState {
    fn add(&mut self, word: &str, lean: &mut String) {
        match self {
            // A blank before a bracket matters in a directive: `#define F(x)` has a parameter,
            // `#define F (x)` does not.
            Self::Directive => lean.push(' '),
            Self::Empty | Self::Code => write_part(lean, word),
        }
        if matches!(self, Self::Empty) {
            *self = if word.starts_with('#') { Self::Directive } else { Self::Code };
        }
        lean.push_str(word);
    }

    fn end(&mut self, lean: &mut String) {
        if !matches!(self, Self::Empty) {
            lean.push('\n');
        }
        *self = Self::Empty;
    }
}

/// The end of the run without blanks and comments that begins at `start`.
fn glsl_word_end(text: &str, start: usize) -> usize {
    let bytes = text.as_bytes();
    let mut at = start;
    while at < bytes.len() {
        match bytes[at] {
            b' ' | b'\n' | b'\t' | b'\r' | b'\x0c' => break,
            b'/' if glsl_comment_length(&text[at..]) > 0 => break,
            _ => at += 1,
        }
    }
    at
}

/// Length of the comment that a text with `/` as its first byte begins with; 0 if that is no
/// comment. Block comments do not nest.
fn glsl_comment_length(text: &str) -> usize {
    match text.as_bytes() {
        [_, b'/', ..] => text.find(['\n', '\r']).unwrap_or(text.len()),
        [_, b'*', ..] => text[2..].find("*/").map_or(text.len(), |end| end + 4),
        _ => 0,
    }
}
