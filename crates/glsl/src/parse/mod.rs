//! The parser: tokens to declarations. It goes on after an error, at the next statement or
//! declaration, so that an editor gets all that can be read.

mod decl;
mod expr;
mod stmt;

use crate::ast::{Item, Name};
use crate::lexer::{At, Kind, Lexed, Token, mark, tokenize};

/// How deep brackets, operators and statements may nest.
pub const NESTING: u32 = 100;

/// An error of the grammar.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SyntaxError {
    /// Where.
    pub at: At,
    /// What was expected or found.
    pub message: String,
}

/// A text as declarations.
#[derive(Debug)]
pub struct Parsed<'a> {
    /// The declarations, with their places.
    pub items: Vec<(Item<'a>, At)>,
    /// Errors, in order.
    pub errors: Vec<SyntaxError>,
    /// The tokens, comments and directives.
    pub lexed: Lexed,
}

/// An error that was recorded.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Failed;

pub(crate) type Res<T> = Result<T, Failed>;

/// Parses a preprocessed text.
pub fn parse(text: &str) -> Parsed<'_> {
    let lexed = tokenize(text);
    let mut parser = Parser { text, tokens: &lexed.tokens, at: 0, depth: 0, errors: Vec::new() };
    let mut items = Vec::new();
    while !parser.at_end() {
        let start = parser.token().at;
        let before = parser.at;
        match parser.item() {
            Ok(item) => items.push((item, start.to(parser.last_at()))),
            Err(Failed) => parser.skip_item(before),
        }
    }
    let errors = parser.errors;
    Parsed { items, errors, lexed }
}

pub(crate) struct Parser<'a, 't> {
    text: &'a str,
    tokens: &'t [Token],
    at: usize,
    depth: u32,
    errors: Vec<SyntaxError>,
}

impl<'a> Parser<'a, '_> {
    fn token(&self) -> Token {
        self.ahead(0)
    }

    fn ahead(&self, count: usize) -> Token {
        let last = self.tokens.len() - 1;
        self.tokens[(self.at + count).min(last)]
    }

    fn at_end(&self) -> bool {
        self.token().kind == Kind::End
    }

    fn last_at(&self) -> At {
        self.tokens[self.at.saturating_sub(1).min(self.tokens.len() - 1)].at
    }

    fn text_of(&self, token: Token) -> &'a str {
        &self.text[token.at.range()]
    }

    fn advance(&mut self) -> Token {
        let token = self.token();
        if token.kind != Kind::End {
            self.at += 1;
        }
        token
    }

    fn is(&self, text: &'static str) -> bool {
        self.token().kind == mark(text)
    }

    fn take(&mut self, text: &'static str) -> bool {
        let found = self.is(text);
        if found {
            self.at += 1;
        }
        found
    }

    fn is_word(&self, word: &str) -> bool {
        let token = self.token();
        token.kind == Kind::Word && self.text_of(token) == word
    }

    fn take_word(&mut self, word: &str) -> bool {
        let found = self.is_word(word);
        if found {
            self.at += 1;
        }
        found
    }

    fn expect(&mut self, text: &'static str) -> Res<At> {
        if self.is(text) {
            return Ok(self.advance().at);
        }
        let found = self.describe(self.token());
        self.fail(self.token().at, format!("expected `{text}`, found {found}"))
    }

    fn name(&mut self) -> Res<Name<'a>> {
        let token = self.token();
        if token.kind == Kind::Word {
            self.at += 1;
            return Ok(Name { text: self.text_of(token), at: token.at });
        }
        let found = self.describe(token);
        self.fail(token.at, format!("expected a name, found {found}"))
    }

    fn describe(&self, token: Token) -> String {
        match token.kind {
            Kind::End => "the end of the text".to_owned(),
            _ => format!("`{}`", self.text_of(token)),
        }
    }

    fn fail<T>(&mut self, at: At, message: String) -> Res<T> {
        // One mistake often makes many errors; the first hundred are enough.
        if self.errors.len() < 100 {
            self.errors.push(SyntaxError { at, message });
        }
        Err(Failed)
    }

    /// Runs a part of the parser one level deeper.
    fn deeper<T>(&mut self, parse: impl FnOnce(&mut Self) -> Res<T>) -> Res<T> {
        if self.depth >= NESTING {
            let at = self.token().at;
            return self.fail(at, format!("nested more than {NESTING} levels deep"));
        }
        self.depth += 1;
        let result = parse(self);
        self.depth -= 1;
        result
    }

    /// To the end of a broken declaration: a `;` or a `}` outside of all brackets.
    fn skip_item(&mut self, before: usize) {
        self.at = self.at.max(before);
        self.depth = 0;
        let mut open = 0_u32;
        // What was read before the error may have opened braces.
        for token in &self.tokens[before..self.at] {
            open = nested(open, token.kind);
        }
        while !self.at_end() {
            let kind = self.advance().kind;
            open = nested(open, kind);
            if open == 0 && (kind == mark(";") || kind == mark("}")) {
                self.take(";");
                return;
            }
        }
    }

    /// To the end of a broken statement: after its `;`, or before the `}` of its block.
    fn skip_statement(&mut self, before: usize) {
        if self.at == before && !self.is("}") {
            self.advance();
        }
        let mut open = 0_u32;
        while !self.at_end() {
            if open == 0 && self.is("}") {
                return;
            }
            let kind = self.advance().kind;
            open = nested(open, kind);
            if open == 0 && (kind == mark(";") || kind == mark("}")) {
                return;
            }
        }
    }
}

fn nested(open: u32, kind: Kind) -> u32 {
    if kind == mark("{") {
        open + 1
    } else if kind == mark("}") {
        open.saturating_sub(1)
    } else {
        open
    }
}
