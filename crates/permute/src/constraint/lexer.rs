//! Words and signs of a constraint.

use std::ops::Range;

use lamplight_syntax::words::{begins_word, word_end};

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TokenKind {
    /// An identifier, `in`, `true` and `false` among them.
    Word,
    /// A decimal integer, perhaps negative.
    Number,
    /// One of [`SIGNS`].
    Sign,
    /// A character with which no token starts.
    Stray,
    /// After the last token.
    End,
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Token<'a> {
    pub kind: TokenKind,
    pub text: &'a str,
    pub range: Range<usize>,
}

/// Longer signs come first, so that `<=` is not read as `<`.
const SIGNS: &[&str] =
    &["=>", "==", "!=", "<=", ">=", "&&", "||", "!", "(", ")", "[", "]", ",", "<", ">"];

/// The tokens of the text, closed by one of kind [`TokenKind::End`].
pub fn constraint_tokens(text: &str) -> Vec<Token<'_>> {
    let mut tokens = Vec::new();
    let mut at = 0;
    while let Some(first) = text[at..].chars().next() {
        if first.is_whitespace() {
            at += first.len_utf8();
            continue;
        }
        let (kind, length) = next_token(&text[at..], first);
        tokens.push(Token { kind, text: &text[at..at + length], range: at..at + length });
        at += length;
    }
    tokens.push(Token { kind: TokenKind::End, text: "", range: text.len()..text.len() });
    tokens
}

fn next_token(rest: &str, first: char) -> (TokenKind, usize) {
    let run = |from: usize| word_end(rest, from);
    if let Some(sign) = SIGNS.iter().find(|sign| rest.starts_with(**sign)) {
        return (TokenKind::Sign, sign.len());
    }
    match first {
        '-' if rest[1..].starts_with(|c: char| c.is_ascii_digit()) => (TokenKind::Number, run(1)),
        _ if first.is_ascii_digit() => (TokenKind::Number, run(0)),
        _ if begins_word(first) => (TokenKind::Word, run(0)),
        _ => (TokenKind::Stray, first.len_utf8()),
    }
}
