//! Splits a file into directives, imports and global declarations.

use super::condition::{self, Attributes, Chain};
use super::cursor::Tokens;
use super::import;
use super::module::{Directive, Item, ItemKind, Module};
use super::name::{Name, Names};
use super::token::Token;
use super::trivia;
use crate::diagnostic::{Diagnostic, codes};

/// Where an item's parts are among the tokens.
#[derive(Debug, Clone, Copy)]
pub struct Place {
    /// Its first attribute, or its keyword.
    pub start: usize,
    pub keyword: usize,
    /// Past its last token.
    pub end: usize,
}

const KINDS: &[(Name, ItemKind)] = &[
    (Name::FN, ItemKind::Function),
    (Name::STRUCT, ItemKind::Struct),
    (Name::CONST, ItemKind::Const),
    (Name::OVERRIDE, ItemKind::Override),
    (Name::VAR, ItemKind::Var),
    (Name::ALIAS, ItemKind::Alias),
    (Name::CONST_ASSERT, ItemKind::ConstAssert),
];

/// Fills the module's directives, imports and items; the items without their events yet.
pub fn split(module: &mut Module, tokens: &[Token], names: &Names) -> Vec<Place> {
    let text = std::sync::Arc::clone(&module.text);
    let tokens = Tokens { tokens, text: &text, names, source: module.source };
    let mut splitter =
        Splitter { module, tokens, chain: Chain::default(), places: Vec::new(), behind: 0 };
    let mut at = 0;
    while at < tokens.len() {
        let end = match splitter.node(at) {
            Ok(end) => end,
            Err(error) => {
                splitter.module.errors.push(error);
                recover(tokens, at)
            }
        };
        splitter.behind = trivia::trailing(&text, tokens.range(at, end).end, tokens.start(end));
        at = end;
    }
    splitter.places
}

/// Past the next semicolon or braces outside brackets.
fn recover(tokens: Tokens<'_>, from: usize) -> usize {
    let mut at = from;
    while at < tokens.len() {
        if tokens.is(at, b';') {
            return at + 1;
        }
        let braces = tokens.is(at, b'{');
        at = tokens.partner(at).max(at) + 1;
        if braces {
            return at;
        }
    }
    at
}

struct Splitter<'a, 'b> {
    module: &'a mut Module,
    tokens: Tokens<'b>,
    chain: Chain,
    places: Vec<Place>,
    /// The byte where what came before ended.
    behind: u32,
}

impl Splitter<'_, '_> {
    fn node(&mut self, at: usize) -> Result<usize, Diagnostic> {
        if self.tokens.is(at, b';') {
            return Ok(at + 1);
        }
        let attributes = condition::attributes(self.module, self.tokens, at, &mut self.chain);
        let keyword = attributes.end;
        match self.tokens.word(keyword) {
            Some(Name::IMPORT) => self.import(keyword, attributes),
            Some(word @ (Name::ENABLE | Name::REQUIRES | Name::DIAGNOSTIC)) => {
                self.directive(keyword, word, attributes)
            }
            word => match KINDS.iter().find(|(name, _)| Some(*name) == word) {
                Some((_, kind)) => self.item(at, attributes, *kind),
                None => Err(self.tokens.expected(keyword, "a declaration")),
            },
        }
    }

    fn import(&mut self, keyword: usize, attributes: Attributes) -> Result<usize, Diagnostic> {
        if !self.places.is_empty() {
            let error = Diagnostic::error(codes::SYNTAX_ERROR, "an `import` after a declaration");
            self.module
                .errors
                .push(error.at(self.tokens.span(keyword), "imports come first in a file"));
        }
        import::import(self.module, self.tokens, keyword, attributes.condition)
    }

    fn directive(
        &mut self,
        keyword: usize,
        word: Name,
        attributes: Attributes,
    ) -> Result<usize, Diagnostic> {
        let end = self
            .tokens
            .find(keyword, self.tokens.len(), b';')
            .ok_or_else(|| self.unended(keyword, "the directive"))?;
        let range = self.tokens.range(keyword, end + 1);
        let names = (keyword + 1..end).filter(|at| !self.tokens.is(*at, b'(')).collect::<Vec<_>>();
        // The words of `diagnostic(...)` are inside the parentheses that `find` jumped over.
        let names = names.into_iter().filter_map(|at| self.tokens.word(at)).collect();
        self.module.directives.push(Directive {
            keyword: word,
            condition: attributes.condition,
            range,
            names,
        });
        Ok(end + 1)
    }

    fn item(
        &mut self,
        start: usize,
        attributes: Attributes,
        kind: ItemKind,
    ) -> Result<usize, Diagnostic> {
        let keyword = attributes.end;
        let name_at = self.name_at(keyword, kind);
        let name = match kind {
            ItemKind::ConstAssert => Name::UNDERSCORE,
            _ => self.tokens.identifier(name_at, "a name")?,
        };
        let end = self.end(keyword, kind)?;
        let text = self.tokens.text;
        let bytes = self.tokens.range(start, end);
        let first = trivia::leading(text, self.behind, bytes.start);
        let last = trivia::trailing(text, bytes.end, self.tokens.start(end));
        self.module.items.push(Item {
            kind,
            name,
            name_range: self.tokens.range(name_at, name_at + 1),
            range: first..last,
            condition: attributes.condition,
            entry: attributes.entry && kind == ItemKind::Function,
            events: Vec::new(),
            locals: Vec::new(),
            free: Vec::new(),
        });
        self.places.push(Place { start, keyword, end });
        Ok(end)
    }

    /// The token of the declared name; the keyword's for a `const_assert`.
    fn name_at(&self, keyword: usize, kind: ItemKind) -> usize {
        match kind {
            ItemKind::ConstAssert => keyword,
            ItemKind::Var => after_template(self.tokens, keyword + 1),
            _ => keyword + 1,
        }
    }

    fn end(&self, keyword: usize, kind: ItemKind) -> Result<usize, Diagnostic> {
        let braced = matches!(kind, ItemKind::Function | ItemKind::Struct);
        let mut at = keyword;
        while at < self.tokens.len() {
            match (self.tokens.is(at, b';'), self.tokens.is(at, b'{')) {
                (true, _) if !braced => return Ok(at + 1),
                (_, true) if braced => return Ok(self.tokens.partner(at) + 1),
                (false, false) => at = self.tokens.partner(at).max(at) + 1,
                _ => break,
            }
        }
        Err(self.unended(keyword, if braced { "the body" } else { "the declaration" }))
    }

    fn unended(&self, keyword: usize, what: &str) -> Diagnostic {
        let limit = self.tokens.len();
        let mark = if what == "the body" { "{" } else { ";" };
        let stop = (keyword + 1..limit).find(|at| self.starts_node(*at)).unwrap_or(limit);
        let label = if stop > keyword + 1 { stop - 1 } else { keyword };
        Diagnostic::error(
            codes::SYNTAX_ERROR,
            format!("{what} of `{}` lacks its `{mark}`", self.tokens.text(keyword)),
        )
        .at(self.tokens.span(label), format!("expected `{mark}` after this"))
    }

    fn starts_node(&self, at: usize) -> bool {
        let word = self.tokens.word(at);
        self.tokens.is(at, b'@')
            || self.tokens.is(at, b'{')
            || KINDS.iter().any(|(name, _)| Some(*name) == word)
    }
}

/// Past `<...>`, if one starts here.
pub fn after_template(tokens: Tokens<'_>, at: usize) -> usize {
    if !tokens.is(at, b'<') {
        return at;
    }
    let mut depth = 0;
    let mut end = at;
    while end < tokens.len() {
        match (tokens.is(end, b'<'), tokens.is(end, b'>')) {
            (true, _) => depth += 1,
            (_, true) => depth -= 1,
            _ if tokens.is(end, b';') => return at,
            _ => end = tokens.partner(end).max(end),
        }
        end += 1;
        if depth == 0 {
            return end;
        }
    }
    at
}
