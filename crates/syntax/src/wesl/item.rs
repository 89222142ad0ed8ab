//! Splits a file into directives, imports and global declarations.

use super::block;
use super::condition::{self, Attributes, Chain};
use super::cursor::Tokens;
use super::import;
use super::module::{Directive, Event, Item, ItemKind, Module};
use super::name::{Name, Names};
use super::token::Token;
use super::trivia;
use lamplight_diagnostic::{Diagnostic, codes};

/// Where the parts of an item are among the tokens.
#[derive(Debug, Clone, Copy)]
pub struct ItemPlace {
    /// Its first attribute, or its keyword.
    pub start: usize,
    pub keyword: usize,
    /// After its last token.
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

/// Fills the module's directives, imports and items. The items do not have their events yet.
/// Returns where each item is among the tokens.
pub fn split_items(module: &mut Module, tokens: &[Token], names: &Names) -> Vec<ItemPlace> {
    let text = std::sync::Arc::clone(&module.text);
    let tokens = Tokens { tokens, text: &text, names, source: module.source };
    let mut splitter = ItemSplitter {
        module,
        tokens,
        chain: Chain::default(),
        places: Vec::new(),
        behind: 0,
        limit: tokens.len(),
        declared: false,
    };
    splitter.nodes(0);
    splitter.places
}

/// The index after the next semicolon or closing brace that is outside of brackets.
fn recover_from(tokens: Tokens<'_>, from: usize, limit: usize) -> usize {
    let mut at = from;
    while at < limit {
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

struct ItemSplitter<'a, 'b> {
    module: &'a mut Module,
    tokens: Tokens<'b>,
    chain: Chain,
    places: Vec<ItemPlace>,
    /// The byte at which the item before ended.
    behind: u32,
    /// The end of the file, or the brace that ends the block.
    limit: usize,
    /// Whether the file, or the block that is being read, has had a declaration so far.
    declared: bool,
}

impl ItemSplitter<'_, '_> {
    /// The nodes from a token up to the limit.
    fn nodes(&mut self, from: usize) {
        let mut at = from;
        while at < self.limit {
            let end = match self.node(at) {
                Ok(end) => end,
                Err(error) => {
                    self.module.errors.push(error);
                    recover_from(self.tokens, at, self.limit)
                }
            };
            let tokens = self.tokens;
            self.behind =
                trivia::trailing_end(tokens.text, tokens.range(at, end).end, tokens.start(end));
            at = end;
        }
    }

    fn node(&mut self, at: usize) -> Result<usize, Diagnostic> {
        if self.tokens.is(at, b';') {
            return Ok(at + 1);
        }
        let attributes = condition::read_attributes(self.module, self.tokens, at, &mut self.chain);
        let keyword = attributes.end;
        if self.tokens.is(keyword, b'{') {
            return self.block(at, attributes);
        }
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

    /// Reads declarations in braces, which all have the condition before the braces. The braces are
    /// removed, and the comments above them stay with the first declaration.
    fn block(&mut self, start: usize, attributes: Attributes) -> Result<usize, Diagnostic> {
        let (tokens, open) = (self.tokens, attributes.end);
        block::check_attributes(tokens, start, attributes)?;
        let condition = match attributes.condition {
            Some(condition) if attributes.conditional => condition,
            _ => {
                self.module.warnings.push(block::unreachable_braces(tokens, open));
                condition::literal_condition(self.module, false, &self.chain)
            }
        };
        let (close, first) = (tokens.partner(open), self.module.items.len());
        let head = tokens.range(start, open + 1);
        let above = trivia::leading_start(tokens.text, self.behind, head.start);
        let chain = std::mem::replace(&mut self.chain, Chain::within(Some(condition)));
        let limit = std::mem::replace(&mut self.limit, close);
        let declared = std::mem::replace(&mut self.declared, false);
        self.behind = trivia::trailing_end(tokens.text, head.end, tokens.start(open + 1));
        self.nodes(open + 1);
        (self.chain, self.limit, self.declared) = (chain, limit, declared || self.declared);
        if let Some(item) = self.module.items.get_mut(first).filter(|_| above < head.start) {
            item.events.insert(0, Event::Cut { start: head.start, end: item.range.start });
            item.range.start = above;
        }
        Ok(close + 1)
    }

    fn import(&mut self, keyword: usize, attributes: Attributes) -> Result<usize, Diagnostic> {
        if self.chain.within.is_some() {
            self.module.warnings.push(block::import_inside(self.tokens, keyword));
        }
        if self.declared {
            let error = Diagnostic::error(codes::SYNTAX_ERROR, "an `import` after a declaration");
            self.module
                .errors
                .push(error.at(self.tokens.span(keyword), "imports come first in a file"));
        }
        import::read_import(self.module, self.tokens, keyword, attributes.condition)
    }

    fn directive(
        &mut self,
        keyword: usize,
        word: Name,
        attributes: Attributes,
    ) -> Result<usize, Diagnostic> {
        let end = self
            .tokens
            .find(keyword, self.limit, b';')
            .ok_or_else(|| self.unended(keyword, "the directive"))?;
        let range = self.tokens.range(keyword, end + 1);
        let names = (keyword + 1..end).filter(|at| !self.tokens.is(*at, b'(')).collect::<Vec<_>>();
        // `find` jumped over the parentheses of `diagnostic(...)`, so its words are inside.
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
        let mut first = trivia::leading_start(text, self.behind, bytes.start);
        if self.chain.within.is_some() {
            // In a block every line keeps its indentation, the first one included.
            first = block::line_start(text, first).max(self.behind);
        }
        self.declared = true;
        let last = trivia::trailing_end(text, bytes.end, self.tokens.start(end));
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
        self.places.push(ItemPlace { start, keyword, end });
        Ok(end)
    }

    /// The token with the declared name; for a `const_assert`, the keyword.
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
        while at < self.limit {
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
        let limit = self.limit;
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

/// The index after the `<...>` that starts at `at`; `at` itself if none does.
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
