//! What a word and a number are, in one place.
//!
//! A text that is read in full is split by the tokenizer of its language, [`wesl`](super::wesl) or
//! [`glsl`](super::glsl). [`words`] and [`pieces`] are for texts of which less is asked, or whose
//! language has no tokenizer here: what naga writes, expressions, formulas, lines of a page.

use std::ops::Range;

/// Whether an identifier may begin with the character. The rule is that of WGSL, which includes
/// those of GLSL and of the C family.
pub fn begins_word(letter: char) -> bool {
    match letter {
        'a'..='z' | 'A'..='Z' | '_' => true,
        _ => !letter.is_ascii() && unicode_ident::is_xid_start(letter),
    }
}

/// Whether an identifier may have the character after its first one.
pub fn continues_word(letter: char) -> bool {
    match u8::try_from(letter) {
        Ok(byte) if byte.is_ascii() => is_word_byte(byte),
        _ => unicode_ident::is_xid_continue(letter),
    }
}

/// The ASCII part of [`continues_word`].
#[inline]
pub fn is_word_byte(byte: u8) -> bool {
    IS_WORD_BYTE[byte as usize]
}

/// A table, which is fast without optimisation too. A dev build of the crate is not optimised, and
/// looks up millions of bytes.
const IS_WORD_BYTE: [bool; 256] = {
    let mut table = [false; 256];
    let mut byte = 0;
    while byte < 128 {
        table[byte] = (byte as u8).is_ascii_alphanumeric() || byte as u8 == b'_';
        byte += 1;
    }
    table
};

/// Whether the whole text is one identifier, or a keyword.
pub fn is_word(text: &str) -> bool {
    text.starts_with(begins_word) && leading_word(text).len() == text.len()
}

/// The letters, digits and underscores that a text starts with.
pub fn leading_word(text: &str) -> &str {
    &text[..word_end(text, 0)]
}

/// The end of the letters, digits and underscores from a byte on.
#[inline]
pub fn word_end(text: &str, start: usize) -> usize {
    let bytes = text.as_bytes();
    let mut at = start;
    while at < bytes.len() {
        if IS_WORD_BYTE[bytes[at] as usize] {
            at += 1;
        } else if let Some(letter) = beyond_ascii(text, at).filter(|found| continues_word(*found)) {
            at += letter.len_utf8();
        } else {
            break;
        }
    }
    at
}

/// A range with the letters, digits and underscores on both sides of it.
pub fn word_around(text: &str, range: Range<usize>) -> Range<usize> {
    text[..range.start].trim_end_matches(continues_word).len()..word_end(text, range.end)
}

/// The character at a byte, if it is not ASCII.
fn beyond_ascii(text: &str, at: usize) -> Option<char> {
    if text.as_bytes()[at].is_ascii() { None } else { text.get(at..)?.chars().next() }
}

/// The end of the number that starts at a byte, read loosely: letters, digits and points, with the
/// sign of an exponent.
pub fn number_end(text: &str, start: usize) -> usize {
    let bytes = text.as_bytes();
    let is_hexadecimal = matches!(bytes.get(start..start + 2), Some(b"0x" | b"0X"));
    let exponents = if is_hexadecimal { b"pP" } else { b"eE" };
    let mut at = start;
    loop {
        match bytes.get(at) {
            Some(byte) if byte.is_ascii_alphanumeric() || *byte == b'.' => at += 1,
            Some(b'+' | b'-') if at > start && exponents.contains(&bytes[at - 1]) => at += 1,
            _ => return at,
        }
    }
}

/// What a piece of a text is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LexemeKind {
    Word,
    Number,
    /// A run of white space.
    Blank,
    /// Any other single character.
    Sign,
}

/// A piece of a text. All pieces of a text, joined, are the text again.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Lexeme<'a> {
    pub kind: LexemeKind,
    pub text: &'a str,
    /// Where it starts.
    pub at: usize,
}

impl Lexeme<'_> {
    /// The first byte behind it.
    pub fn end(&self) -> usize {
        self.at + self.text.len()
    }
}

/// The pieces of a text in order. Comments are no pieces of their own.
pub fn pieces(text: &str) -> impl Iterator<Item = Lexeme<'_>> {
    let mut at = 0;
    std::iter::from_fn(move || {
        let found = piece_at(text, at)?;
        at = found.end();
        Some(found)
    })
}

/// The piece that starts at a byte.
#[inline]
pub fn piece_at(text: &str, at: usize) -> Option<Lexeme<'_>> {
    let bytes = text.as_bytes();
    let is_digit = |at: usize| bytes.get(at).is_some_and(u8::is_ascii_digit);
    let (kind, end) = match *bytes.get(at)? {
        b'a'..=b'z' | b'A'..=b'Z' | b'_' => (LexemeKind::Word, word_end(text, at)),
        b'0'..=b'9' => (LexemeKind::Number, number_end(text, at)),
        b'.' if is_digit(at + 1) => (LexemeKind::Number, number_end(text, at)),
        b'!'..=b'~' => (LexemeKind::Sign, at + 1),
        b' ' if matches!(bytes.get(at + 1), Some(b'!'..=b'~')) => (LexemeKind::Blank, at + 1),
        byte if byte.is_ascii() && !byte.is_ascii_whitespace() => (LexemeKind::Sign, at + 1),
        _ => match text[at..].chars().next()? {
            letter if begins_word(letter) => (LexemeKind::Word, word_end(text, at)),
            letter if letter.is_whitespace() => {
                (LexemeKind::Blank, text.len() - text[at..].trim_start().len())
            }
            letter => (LexemeKind::Sign, at + letter.len_utf8()),
        },
    };
    Some(Lexeme { kind, text: &text[at..end], at })
}

/// An identifier or a keyword.
#[derive(Debug, Clone, Copy)]
pub struct Word<'a> {
    pub text: &'a str,
    /// Where it starts.
    pub at: usize,
    /// The last byte before it that is not white space; a blank where there is none.
    pub before: u8,
}

/// Every identifier and keyword. Letters within a number, such as an exponent, do not count.
pub fn words(text: &str) -> impl Iterator<Item = Word<'_>> {
    let (mut at, mut before) = (0, b' ');
    std::iter::from_fn(move || {
        while let Some(piece) = piece_at(text, at) {
            let last = before;
            at = piece.end();
            if piece.kind != LexemeKind::Blank {
                before = text.as_bytes()[at - 1];
            }
            if piece.kind == LexemeKind::Word {
                return Some(Word { text: piece.text, at: piece.at, before: last });
            }
        }
        None
    })
}

/// Whether a text has a word.
pub fn has_word(text: &str, word: &str) -> bool {
    words(text).any(|found| found.text == word)
}

/// Whether both are the same. Unlike `==`, this can be used in constants.
pub const fn same_bytes(left: &[u8], right: &[u8]) -> bool {
    let mut index = 0;
    while index < left.len() && index < right.len() && left[index] == right[index] {
        index += 1;
    }
    index == left.len() && index == right.len()
}
