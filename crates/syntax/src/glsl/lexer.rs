//! Splits text into tokens, once for each file. Spellings become numbers, so that tokens are small and
//! cheap to compare.

use crate::words::{is_word_byte, same_bytes};
use std::collections::HashMap;
use std::sync::Arc;

/// What a token is, as far as that matters to the preprocessor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TokenKind {
    Identifier,
    Number,
    Punctuation,
    /// A character that no GLSL token begins with.
    Other,
}

/// A token, and what stands before it.
#[derive(Debug, Clone, Copy)]
pub struct Token {
    /// Spelling, without line continuations.
    pub symbol: Symbol,
    /// First byte.
    pub start: u32,
    /// One past the last byte.
    pub end: u32,
    pub kind: TokenKind,
    /// Whether white space or a comment stands before it.
    pub spaced: bool,
    /// Whether it is the first of its logical line.
    pub first_of_line: bool,
    /// Whether it is the first token of its part of the file, which is a run of text or a
    /// directive.
    pub first_of_part: bool,
    /// Whether it can be copied together with what stands before it. That must have no line
    /// continuations, carriage returns, trailing white space or runs of blank lines, and no
    /// directive may be between.
    pub clean: bool,
}

impl Token {
    /// The bytes it covers.
    pub fn range(&self) -> std::ops::Range<usize> {
        self.start as usize..self.end as usize
    }
}

/// Why and where a text cannot be split into tokens.
#[derive(Debug)]
pub enum LexError {
    /// The `/*` at this byte has no `*/`.
    OpenComment(usize),
    /// There are more tokens than the limit; this is the byte of the first one beyond it.
    TooMany(usize),
}

/// Splits a text into tokens, at most `limit`.
pub fn tokenize(text: &str, symbols: &mut Symbols, limit: usize) -> Result<Vec<Token>, LexError> {
    let mut tokens = Vec::with_capacity(text.len() / 4);
    let mut at = 0;
    loop {
        let gap = skip_gap(text.as_bytes(), at)?;
        let start = gap.end;
        if start >= text.len() {
            return Ok(tokens);
        }
        if tokens.len() == limit {
            return Err(LexError::TooMany(start));
        }
        let (kind, end) = scan_token(text, start);
        let spelling = &text[start..end];
        let spliced = spelling.contains('\\') && spelling.len() > 1;
        let symbol = if spliced {
            symbols.intern(&without_splices(spelling))
        } else {
            symbols.intern(spelling)
        };
        tokens.push(Token {
            symbol,
            start: start as u32,
            end: end as u32,
            kind,
            spaced: start > at,
            first_of_line: gap.newline || tokens.is_empty(),
            first_of_part: false,
            clean: !spliced && is_clean(&text[at..start]),
        });
        at = end;
    }
}

/// The byte after the logical line that `at` stands on; `at` is outside of tokens.
pub fn line_end(text: &str, mut at: usize) -> usize {
    let bytes = text.as_bytes();
    while at < bytes.len() {
        at = match bytes[at] {
            b'\n' => return at + 1,
            b'\\' => at + splice_length(bytes, at).max(1),
            b'/' if bytes.get(at + 1) == Some(&b'/') => line_comment_end(bytes, at),
            b'/' if bytes.get(at + 1) == Some(&b'*') => {
                block_comment_end(bytes, at).unwrap_or(bytes.len())
            }
            _ => at + 1,
        };
    }
    at
}

struct Gap {
    end: usize,
    newline: bool,
}

fn skip_gap(bytes: &[u8], mut at: usize) -> Result<Gap, LexError> {
    let mut newline = false;
    loop {
        at = match bytes.get(at) {
            Some(b'\n') => {
                newline = true;
                at + 1
            }
            Some(b' ' | b'\t' | b'\r' | 0x0b | 0x0c) => at + 1,
            Some(b'/') if bytes.get(at + 1) == Some(&b'/') => line_comment_end(bytes, at),
            Some(b'/') if bytes.get(at + 1) == Some(&b'*') => {
                block_comment_end(bytes, at).ok_or(LexError::OpenComment(at))?
            }
            Some(b'\\') if splice_length(bytes, at) > 0 => at + splice_length(bytes, at),
            _ => return Ok(Gap { end: at, newline }),
        };
    }
}

/// Length of a line continuation at this byte; 0 if there is none.
fn splice_length(bytes: &[u8], at: usize) -> usize {
    match bytes.get(at..) {
        Some([b'\\', b'\r', b'\n', ..]) => 3,
        Some([b'\\', b'\n', ..]) => 2,
        _ => 0,
    }
}

/// The end of the line comment that begins at a byte, without its line break. Backslashes at the
/// ends of lines continue it.
pub fn line_comment_end(bytes: &[u8], mut at: usize) -> usize {
    while at < bytes.len() && bytes[at] != b'\n' {
        at += splice_length(bytes, at).max(1);
    }
    at
}

/// The end of the block comment that begins at a byte, if it is closed.
pub fn block_comment_end(bytes: &[u8], at: usize) -> Option<usize> {
    bytes[at + 2..].windows(2).position(|pair| pair == b"*/").map(|offset| at + 2 + offset + 2)
}

fn is_clean(gap: &str) -> bool {
    gap.len() <= 1 || !["\r", "\\\n", "\n\n\n", " \n", "\t\n"].iter().any(|flaw| gap.contains(flaw))
}

fn without_splices(spelling: &str) -> String {
    spelling.replace("\\\r\n", "").replace("\\\n", "")
}

fn scan_token(text: &str, start: usize) -> (TokenKind, usize) {
    let bytes = text.as_bytes();
    match bytes[start] {
        b'a'..=b'z' | b'A'..=b'Z' | b'_' => (TokenKind::Identifier, word_end(bytes, start)),
        b'0'..=b'9' => (TokenKind::Number, number_end(bytes, start)),
        b'.' if bytes.get(start + 1).is_some_and(u8::is_ascii_digit) => {
            (TokenKind::Number, number_end(bytes, start))
        }
        _ => match punctuation_length(&bytes[start..]) {
            0 => (TokenKind::Other, start + text[start..].chars().next().map_or(1, char::len_utf8)),
            length => (TokenKind::Punctuation, start + length),
        },
    }
}

fn word_end(bytes: &[u8], mut at: usize) -> usize {
    loop {
        match bytes.get(at) {
            Some(byte) if is_word_byte(*byte) => at += 1,
            Some(b'\\') if splice_length(bytes, at) > 0 => at += splice_length(bytes, at),
            _ => return at,
        }
    }
}

fn number_end(bytes: &[u8], start: usize) -> usize {
    let hexadecimal = bytes[start] == b'0' && matches!(bytes.get(start + 1), Some(b'x' | b'X'));
    let mut at = start;
    loop {
        at = word_end(bytes, at);
        let exponent = !hexadecimal && at > start && matches!(bytes[at - 1], b'e' | b'E');
        match bytes.get(at) {
            Some(b'.') => at += 1,
            Some(b'+' | b'-') if exponent => at += 1,
            _ => return at,
        }
    }
}

const PUNCTUATION: &[&str] = &[
    "<<=", ">>=", "##", "<=", ">=", "==", "!=", "&&", "||", "^^", "++", "--", "+=", "-=", "*=",
    "/=", "%=", "&=", "|=", "^=", "<<", ">>",
];

fn punctuation_length(rest: &[u8]) -> usize {
    if let Some(long) = PUNCTUATION.iter().find(|text| rest.starts_with(text.as_bytes())) {
        return long.len();
    }
    usize::from(b"#()[]{}<>,;:?.+-*/%!~&|^=".contains(&rest[0]))
}

/// The class of a spelling, if that is exactly one token.
pub fn single_token(text: &str) -> Option<TokenKind> {
    if text.is_empty() {
        return None;
    }
    let (kind, end) = scan_token(text, 0);
    (end == text.len() && kind != TokenKind::Other).then_some(kind)
}

/// Index of a spelling in its [`Symbols`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Symbol(pub u32);

impl Symbol {
    /// As an index into tables by symbol.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

macro_rules! known {
    ($($name:ident $text:literal)*) => {
        /// Spellings that the composer itself uses. They have the same numbers in every
        /// [`Symbols`].
        pub mod known {
            use super::{Symbol, known_position};
            $(#[doc = $text] pub const $name: Symbol = known_position($text);)*
        }

        const KNOWN: &[&str] = &[$($text),*];
    };
}

known! {
    HASH "#" PASTE "##" OPEN "(" CLOSE ")" COMMA "," SEMICOLON ";" DOT "." ASSIGN "="
    OPEN_BRACE "{" CLOSE_BRACE "}" OPEN_BRACKET "[" CLOSE_BRACKET "]"
    PLUS "+" MINUS "-" STAR "*" SLASH "/" PERCENT "%" NOT "!" TILDE "~"
    LESS "<" GREATER ">" LESS_EQUAL "<=" GREATER_EQUAL ">=" EQUAL "==" NOT_EQUAL "!=" SHIFT_LEFT "<<" SHIFT_RIGHT ">>"
    AND "&" OR "|" XOR "^" AND_AND "&&" OR_OR "||" XOR_XOR "^^"
    DEFINED "defined" INCLUDE "include" DEFINE "define" UNDEF "undef"
    IF "if" IFDEF "ifdef" IFNDEF "ifndef" ELIF "elif" ELSE "else" ENDIF "endif"
    ERROR "error" LINE "line" VERSION "version" EXTENSION "extension" PRAGMA "pragma" ONCE "once"
    MACRO_LINE "__LINE__" MACRO_FILE "__FILE__" MACRO_VERSION "__VERSION__"
    MAIN "main" STRUCT "struct" LAYOUT "layout" PRECISION "precision" INVARIANT "invariant" PRECISE "precise"
    IN "in" OUT "out" UNIFORM "uniform" BUFFER "buffer" CONST "const"
    INT "int" PER_VERTEX "gl_PerVertex"
}

/// The number of one of the spellings in `KNOWN`. Any other text is an error at compile time.
const fn known_position(text: &str) -> Symbol {
    let mut index = 0;
    while !same_bytes(KNOWN[index].as_bytes(), text.as_bytes()) {
        index += 1;
    }
    Symbol(index as u32)
}

/// A table of spellings and their numbers.
#[derive(Debug, Clone)]
pub struct Symbols {
    texts: Vec<Arc<str>>,
    index: HashMap<Arc<str>, Symbol>,
}

impl Default for Symbols {
    fn default() -> Self {
        let mut symbols = Self { texts: Vec::new(), index: HashMap::new() };
        for text in KNOWN {
            symbols.intern(text);
        }
        symbols
    }
}

impl Symbols {
    /// The number of a spelling; a new one gets the next number.
    pub fn intern(&mut self, text: &str) -> Symbol {
        if let Some(symbol) = self.find(text) {
            return symbol;
        }
        let symbol = Symbol(self.texts.len() as u32);
        let text: Arc<str> = text.into();
        self.texts.push(text.clone());
        self.index.insert(text, symbol);
        symbol
    }

    /// The number of a spelling that was met before.
    pub fn find(&self, text: &str) -> Option<Symbol> {
        self.index.get(text).copied()
    }

    /// The spelling behind a number of this set.
    pub fn text(&self, symbol: Symbol) -> &str {
        &self.texts[symbol.index()]
    }

    /// How many spellings there are.
    pub fn count(&self) -> usize {
        self.texts.len()
    }
}
