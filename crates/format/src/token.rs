//! Splits a text into tokens without losing anything: comments and lines of the preprocessor are
//! tokens too, and each token knows the blanks before it. The text has `\n` as its only line break.

use lamplight_bundle::Language;
use lamplight_syntax::glsl;
use lamplight_syntax::wesl::blank::{block_comment, is_blank, is_line_break, line_comment};
use lamplight_syntax::wesl::{Piece, template_lists};
use lamplight_syntax::words::{begins_word, number_end, word_end};

/// What a token is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    Word,
    Number,
    /// Punctuation: an operator or a bracket.
    Mark,
    /// The `<` and the `>` of a template list.
    TemplateOpen,
    TemplateClose,
    /// Anything that no token of the language begins with. Blanks around it stay as they are.
    Other,
    LineComment,
    BlockComment,
    /// A line of the preprocessor with its continuations.
    Directive,
    /// Whole lines whose brackets do not match. They stay as they are.
    Raw,
}

/// A token, and what stands before it.
#[derive(Debug, Clone, Copy)]
pub struct Token {
    pub kind: Kind,
    pub start: u32,
    pub end: u32,
    /// Line breaks before it; 2 stands for more.
    pub breaks: u8,
    /// Whether blanks stand before it.
    pub spaced: bool,
    /// Whether it is the first in its line, without blanks before it.
    pub is_margin: bool,
    /// The index of the matching bracket; its own for anything else.
    pub partner: u32,
}

impl Token {
    pub fn text<'t>(&self, text: &'t str) -> &'t str {
        &text[self.start as usize..self.end as usize]
    }

    pub fn is_comment(&self) -> bool {
        matches!(self.kind, Kind::LineComment | Kind::BlockComment)
    }

    /// Whether nothing else may stand behind it in its line.
    pub fn ends_line(&self) -> bool {
        matches!(self.kind, Kind::LineComment | Kind::Directive | Kind::Raw)
    }

    /// Whether it must be the first in its line.
    pub fn begins_line(&self) -> bool {
        matches!(self.kind, Kind::Directive | Kind::Raw)
    }
}

/// Operators of several characters, longest first. Those that begin with `<` or `>` are put
/// together once template lists are known.
const LONG: [&str; 16] = [
    "->", "::", "&&", "||", "^^", "==", "!=", "++", "--", "+=", "-=", "*=", "/=", "%=", "&=", "|=",
];
const XOR_ASSIGN: &str = "^=";
const ANGLES: [&str; 6] = ["<<=", ">>=", "<<", ">>", "<=", ">="];

/// The tokens of a text.
pub fn split_tokens(text: &str, language: Language) -> Vec<Token> {
    let mut tokens = Vec::with_capacity(text.len() / 4);
    let mut at = if text.starts_with('\u{feff}') { '\u{feff}'.len_utf8() } else { 0 };
    loop {
        let gap = skip_blanks(text, at);
        if gap.end == text.len() {
            break;
        }
        let is_first = gap.breaks > 0 || tokens.is_empty();
        let (kind, end) = token_at(text, gap.end, is_first, language);
        tokens.push(Token {
            kind,
            start: gap.end as u32,
            end: end as u32,
            breaks: gap.breaks,
            spaced: gap.end > at,
            is_margin: gap.is_margin && is_first,
            partner: tokens.len() as u32,
        });
        at = end;
    }
    if language == Language::Wesl {
        mark_templates(text, &mut tokens);
    }
    join_angles(text, tokens)
}

struct Gap {
    end: usize,
    breaks: u8,
    is_margin: bool,
}

fn skip_blanks(text: &str, start: usize) -> Gap {
    let bytes = text.as_bytes();
    let (mut at, mut breaks, mut is_margin) = (start, 0_u8, true);
    while let Some(byte) = bytes.get(at) {
        match byte {
            b'\n' => {
                (breaks, is_margin) = ((breaks + 1).min(2), true);
                at += 1;
            }
            b' ' | b'\t' => {
                is_margin = false;
                at += 1;
            }
            b'!'..=b'~' => break,
            _ => match text[at..].chars().next().filter(|letter| is_blank(*letter)) {
                Some(letter) => {
                    if is_line_break(letter) {
                        breaks = (breaks + 1).min(2);
                    }
                    is_margin = is_line_break(letter);
                    at += letter.len_utf8();
                }
                None => break,
            },
        }
    }
    Gap { end: at, breaks, is_margin }
}

/// The kind and the end of the token at a byte.
fn token_at(text: &str, at: usize, is_first: bool, language: Language) -> (Kind, usize) {
    let bytes = text.as_bytes();
    let next = bytes.get(at + 1).copied();
    match bytes[at] {
        b'a'..=b'z' | b'A'..=b'Z' | b'_' => (Kind::Word, word_end(text, at)),
        b'0'..=b'9' => (Kind::Number, number_end(text, at)),
        b'.' if next.is_some_and(|byte| byte.is_ascii_digit()) => {
            (Kind::Number, number_end(text, at))
        }
        b'/' if next == Some(b'/') => (Kind::LineComment, line_comment_end(text, at, language)),
        b'/' if next == Some(b'*') => (Kind::BlockComment, block_comment_end(text, at, language)),
        b'#' if is_first && next != Some(b'{') => {
            (Kind::Directive, directive_end(text, at, language))
        }
        b'#' => hash_end(text, at),
        b'"' => match text[at + 1..].find(['"', '\n']) {
            Some(length) if bytes[at + 1 + length] == b'"' => (Kind::Other, at + length + 2),
            _ => (Kind::Other, at + 1),
        },
        b'\\' if next == Some(b'\n') => (Kind::Other, at + 2),
        b'\\' | b'`' | b'$' | b'\'' => (Kind::Other, at + 1),
        byte if byte.is_ascii_punctuation() => (Kind::Mark, at + mark_length(&text[at..])),
        _ => match text[at..].chars().next() {
            Some(letter) if begins_word(letter) => (Kind::Word, word_end(text, at)),
            letter => (Kind::Other, at + letter.map_or(1, char::len_utf8)),
        },
    }
}

fn mark_length(rest: &str) -> usize {
    if rest.starts_with(XOR_ASSIGN) || LONG.iter().any(|long| rest.starts_with(long)) {
        return 2;
    }
    1
}

/// What `naga_oil` replaces in a line, as `#{NAME}` or `#NAME`, is one word.
fn hash_end(text: &str, at: usize) -> (Kind, usize) {
    let rest = &text[at + 1..];
    if let Some(inner) = rest.strip_prefix('{') {
        let length = word_end(inner, 0);
        if length > 0 && inner[length..].starts_with('}') {
            return (Kind::Word, at + 2 + length + 1);
        }
    }
    match word_end(rest, 0) {
        0 => (Kind::Other, at + 1),
        length => (Kind::Word, at + 1 + length),
    }
}

fn line_comment_end(text: &str, at: usize, language: Language) -> usize {
    let end = match language {
        Language::Wesl => at + line_comment(&text[at..]),
        Language::Glsl => glsl::line_comment_end(text.as_bytes(), at),
    };
    trimmed_end(text, at, end)
}

/// The end without the blanks before it. Those behind a backslash stay: without them, the line
/// would go on in the next one.
fn trimmed_end(text: &str, start: usize, end: usize) -> usize {
    let trimmed = text[start..end].trim_end_matches(is_blank);
    match trimmed.ends_with('\\') {
        true => start + text[start..end].trim_end_matches('\n').len(),
        false => start + trimmed.len(),
    }
}

fn block_comment_end(text: &str, at: usize, language: Language) -> usize {
    let (end, is_closed) = match language {
        Language::Wesl => {
            let (length, is_closed) = block_comment(&text[at..]);
            (at + length, is_closed)
        }
        Language::Glsl => match glsl::block_comment_end(text.as_bytes(), at) {
            Some(end) => (end, true),
            None => (text.len(), false),
        },
    };
    if is_closed { end } else { at + text[at..end].trim_end_matches(is_blank).len() }
}

/// The end of a line of the preprocessor. Comments that go on below belong to it, and so do the
/// names in braces that `#import` lists below.
fn directive_end(text: &str, start: usize, language: Language) -> usize {
    let bytes = text.as_bytes();
    let is_import = language == Language::Wesl
        && text[start + 1..].trim_start_matches([' ', '\t']).starts_with("import");
    let (mut at, mut depth) = (start, 0_usize);
    // Up to where the braces of an import are known to go on.
    let mut known = start;
    while at < bytes.len() {
        match (bytes[at], bytes.get(at + 1)) {
            (b'/', Some(b'/')) => at = line_comment_end(text, at, language),
            (b'/', Some(b'*')) => at = block_comment_end(text, at, language),
            (b'\\', Some(b'\n')) => at += 2,
            (b'{', _) if is_import => (at, depth) = (at + 1, depth + 1),
            (b'}', _) if is_import => (at, depth) = (at + 1, depth.saturating_sub(1)),
            (b'\n', _) if depth == 0 => break,
            (b'\n', _) if at >= known => match import_end(&text[at..]) {
                Some(length) => known = at + length,
                None => break,
            },
            _ => at += 1,
        }
    }
    trimmed_end(text, start, at)
}

/// Where a brace of an import closes, if nothing that cannot be in its braces stands before that.
fn import_end(rest: &str) -> Option<usize> {
    rest.find(['}', ';', '(', '=']).filter(|at| rest.as_bytes()[*at] == b'}')
}

/// Marks the brackets of template lists.
fn mark_templates(text: &str, tokens: &mut [Token]) {
    let is_code = |at: &usize| !tokens[*at].is_comment() && tokens[*at].kind != Kind::Directive;
    let code: Vec<usize> = (0..tokens.len()).filter(is_code).collect();
    let piece_at = |at: &usize| {
        let token = &tokens[*at];
        Piece { text: token.text(text), start: token.start, is_word: token.kind == Kind::Word }
    };
    let pieces: Vec<Piece<'_>> = code.iter().map(piece_at).collect();
    for (open, close) in template_lists(&pieces) {
        tokens[code[open]].kind = Kind::TemplateOpen;
        tokens[code[close]].kind = Kind::TemplateClose;
    }
}

/// Puts operators that begin with `<` or `>` together: `<=`, `>>=` and the like.
fn join_angles(text: &str, tokens: Vec<Token>) -> Vec<Token> {
    let mut joined: Vec<Token> = Vec::with_capacity(tokens.len());
    let mut at = 0;
    while at < tokens.len() {
        let mut token = tokens[at];
        let mut count = 1;
        if token.kind == Kind::Mark && matches!(token.text(text), "<" | ">") {
            let long = ANGLES.iter().find_map(|long| joined_length(text, &tokens[at..], long));
            count = long.unwrap_or(1);
            token.end = tokens[at + count - 1].end;
        }
        token.partner = joined.len() as u32;
        joined.push(token);
        at += count;
    }
    joined
}

/// How many tokens the text of an operator is made of, if none of them belongs to a template list.
fn joined_length(text: &str, tokens: &[Token], long: &str) -> Option<usize> {
    let start = tokens[0].start as usize;
    let end = start + long.len();
    if !text[start..].starts_with(long) {
        return None;
    }
    let count = tokens.iter().position(|token| token.end as usize >= end)? + 1;
    let own = &tokens[..count];
    (own.iter().all(|one| one.kind == Kind::Mark) && own[count - 1].end as usize == end)
        .then_some(count)
}
