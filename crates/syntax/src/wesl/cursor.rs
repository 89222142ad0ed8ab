//! Access to tokens by index.

use std::ops::Range;

use super::name::{Name, Names};
use super::token::{Token, TokenKind};
use lamplight_diagnostic::source::{SourceId, Span};
use lamplight_diagnostic::{Diagnostic, codes};

/// The tokens of a file, with what diagnostics about them need.
#[derive(Clone, Copy)]
pub struct Tokens<'a> {
    pub tokens: &'a [Token],
    pub text: &'a str,
    pub names: &'a Names,
    pub source: SourceId,
}

impl<'a> Tokens<'a> {
    pub fn len(self) -> usize {
        self.tokens.len()
    }

    pub fn kind(self, at: usize) -> Option<TokenKind> {
        self.tokens.get(at).map(|token| token.kind)
    }

    pub fn is(self, at: usize, mark: u8) -> bool {
        self.kind(at) == Some(TokenKind::Mark(mark))
    }

    pub fn is_word(self, at: usize, name: Name) -> bool {
        self.kind(at) == Some(TokenKind::Word(name))
    }

    /// The word at a token, if it is one.
    pub fn word(self, at: usize) -> Option<Name> {
        match self.kind(at) {
            Some(TokenKind::Word(name)) => Some(name),
            _ => None,
        }
    }

    /// The identifier at a token, or an error that says what was found instead.
    pub fn identifier(self, at: usize, what: &str) -> Result<Name, Diagnostic> {
        match self.word(at) {
            Some(name) if !name.is_keyword() => Ok(name),
            _ => Err(self.expected(at, what)),
        }
    }

    /// The index of the bracket that closes the one at `at`.
    pub fn partner(self, at: usize) -> usize {
        self.tokens[at].partner as usize
    }

    /// The first `mark` in `from..limit` that is outside of brackets.
    pub fn find(self, from: usize, limit: usize, mark: u8) -> Option<usize> {
        let mut at = from;
        while at < limit {
            if self.is(at, mark) {
                return Some(at);
            }
            at = self.partner(at).max(at) + 1;
        }
        None
    }

    /// The bytes of the tokens `from..to`; `to` is after the last one.
    pub fn range(self, from: usize, to: usize) -> Range<u32> {
        self.start(from)..self.tokens[..to].last().map_or(0, |token| token.end)
    }

    /// The first byte of a token, or the end of the text.
    pub fn start(self, at: usize) -> u32 {
        self.tokens.get(at).map_or(self.text.len() as u32, |token| token.start)
    }

    pub fn span(self, at: usize) -> Span {
        match self.tokens.get(at) {
            Some(token) => Span { source: self.source, start: token.start, end: token.end },
            None => Span::new(self.source, self.text.len()..self.text.len()),
        }
    }

    pub fn text(self, at: usize) -> &'a str {
        self.tokens.get(at).map_or("", |token| &self.text[token.start as usize..token.end as usize])
    }

    /// A syntax error at a token.
    pub fn expected(self, at: usize, what: &str) -> Diagnostic {
        let found = if at < self.len() {
            format!("`{}`", self.text(at))
        } else {
            "the end of the file".to_owned()
        };
        Diagnostic::error(codes::SYNTAX_ERROR, format!("expected {what}, found {found}"))
            .at(self.span(at), format!("expected {what}"))
    }

    /// Steps over the token if it is `mark`; otherwise an error.
    pub fn expect(self, at: usize, mark: u8, what: &str) -> Result<usize, Diagnostic> {
        if self.is(at, mark) { Ok(at + 1) } else { Err(self.expected(at, what)) }
    }
}
