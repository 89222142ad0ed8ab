//! Reads WESL as a tree. Conditions stay in it; nothing is chosen.

mod condition;
mod expression;
mod item;
mod lines;
mod literal;
mod statement;
mod ty;

pub use ty::filled_type;

use std::sync::Arc;

use lamplight_diagnostic::source::{SourceId, Span};
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};
use lamplight_syntax::wesl::{Chain, Names, TokenKind, Tokens, split_module};

use crate::tree::Module;
use condition::ConditionTable;

/// Reads a module. `path` is that of the module, such as `brdf`, `fresnel`.
pub fn read_module(
    path: &[String],
    source: SourceId,
    text: &str,
    enums: &[String],
) -> Result<Module, Diagnostics> {
    let text: Arc<str> = text.into();
    let mut names = Names::default();
    let split = split_module(source, Arc::clone(&text), &mut names)?;
    let tokens = Tokens { tokens: &split.tokens, text: &text, names: &names, source };
    let mut table = ConditionTable { module: split.module, enums, checked: 0 };
    let errors = table.check_axes(&names, source);
    if !errors.is_empty() {
        return Err(errors);
    }
    let mut reader = Reader { tokens, at: 0, table, depth: 0 };
    item::read_items(&mut reader, path, &split.places)
}

/// Reads tokens one after the other. Brackets are known to match, so recursion is as deep as they
/// nest.
struct Reader<'a> {
    tokens: Tokens<'a>,
    /// The next token.
    at: usize,
    table: ConditionTable<'a>,
    /// How deep the tree is here, beside the nesting of brackets: chains of operators, of `else if`.
    depth: usize,
}

/// The deepest tree that is made, beside the nesting of brackets.
const DEPTH: usize = 200;

impl<'a> Reader<'a> {
    fn text(&self) -> &'a str {
        self.tokens.text(self.at)
    }

    fn is(&self, mark: u8) -> bool {
        self.tokens.is(self.at, mark)
    }

    /// Whether marks follow without white space between them.
    fn is_marks(&self, marks: &str) -> bool {
        let last = marks.len() - 1;
        marks.bytes().enumerate().all(|(index, mark)| {
            let at = self.at + index;
            self.tokens.is(at, mark)
                && (index == last || self.tokens.tokens[at].end == self.tokens.start(at + 1))
        })
    }

    fn is_word(&self, word: &str) -> bool {
        matches!(self.tokens.kind(self.at), Some(TokenKind::Word(_))) && self.text() == word
    }

    /// Steps over a mark if it is next.
    fn take(&mut self, mark: u8) -> bool {
        let found = self.is(mark);
        self.at += usize::from(found);
        found
    }

    /// Steps over a word if it is next.
    fn take_word(&mut self, word: &str) -> bool {
        let found = self.is_word(word);
        self.at += usize::from(found);
        found
    }

    fn expect(&mut self, mark: u8) -> Result<(), Diagnostic> {
        self.at = self.tokens.expect(self.at, mark, &format!("`{}`", mark as char))?;
        Ok(())
    }

    fn identifier(&mut self, what: &str) -> Result<String, Diagnostic> {
        self.tokens.identifier(self.at, what)?;
        self.at += 1;
        Ok(self.tokens.text(self.at - 1).to_owned())
    }

    /// From the first byte of a token to the last of the one before the next.
    fn span_from(&self, first: usize) -> Span {
        let range = self.tokens.range(first, self.at.max(first + 1).min(self.tokens.len()));
        Span { source: self.tokens.source, start: range.start, end: range.end }
    }

    fn here(&self) -> Span {
        self.tokens.span(self.at)
    }

    /// Whether a line break stands before a token.
    fn begins_line(&self, at: usize) -> bool {
        let before = at.checked_sub(1).map_or(0, |at| self.tokens.tokens[at].end);
        self.tokens.text[before as usize..self.tokens.start(at) as usize].contains('\n')
    }

    /// The index after the closing bracket of the one that is next.
    fn partner(&self) -> usize {
        self.tokens.partner(self.at)
    }

    /// Goes one level deeper, if that is allowed. The caller takes it back.
    fn deepen(&mut self) -> Result<(), Diagnostic> {
        self.depth += 1;
        match self.depth > DEPTH {
            true => Err(Diagnostic::error(codes::NESTING_TOO_DEEP, "this goes on for too long")
                .at(self.here(), format!("more than {DEPTH} operators, members or branches"))),
            false => Ok(()),
        }
    }

    /// An error for what has a meaning in WESL, and none that this reader knows.
    fn untranslated(&self, span: Span, what: &str) -> Diagnostic {
        untranslated(span, what)
    }
}

/// The error for what cannot be translated.
pub fn untranslated(span: Span, what: impl Into<String>) -> Diagnostic {
    Diagnostic::error(codes::NOT_TRANSLATED, what).at(span, "not translated")
}

/// Siblings under one block.
fn new_chain() -> Chain {
    Chain::within(None)
}
