//! Splits a file into directives, imports and global declarations. `import` statements are flattened
//! to one entry for each name. The comments and blanks that belong to an item are kept, moved and
//! removed together with it.

use crate::wesl::blank::comment_length;
use crate::wesl::condition::{Attributes, Chain};
use crate::wesl::module::{
    ConditionId, Directive, Event, Import, Item, ItemKind, Module, Origin, Path, PathParts,
    Visibility, Wildcard,
};
use crate::wesl::token::{Name, Names, Token, TokenKind, Tokens};
use crate::wesl::{body, condition};
use lamplight_diagnostic::{Diagnostic, codes};
use std::ops::Range;

/// Where the parts of an item are among the tokens.
#[derive(Debug, Clone, Copy)]
pub struct ItemPlace {
    /// Its first attribute, or what comes next.
    pub start: usize,
    /// After its attributes: `public` or `private`, or its keyword.
    pub attributes: usize,
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

/// The index after the next semicolon or closing brace that is outside of brackets, or of the next
/// declaration.
fn recover_from(tokens: Tokens<'_>, from: usize, limit: usize) -> usize {
    let mut at = from;
    let mut first_attribute = None;
    while at < limit {
        if tokens.is(at, b'@') {
            first_attribute = first_attribute.or(Some(at));
            let arguments = at + 2;
            at = if tokens.is(arguments, b'(') { tokens.partner(arguments) + 1 } else { arguments };
            continue;
        }
        let start = first_attribute.take().unwrap_or(at);
        let is_named = tokens.word(at + 1).is_some() || tokens.is(at + 1, b'<');
        if begins_declaration(tokens, at) && is_named && start > from {
            return start;
        }
        if tokens.is(at, b';') {
            return at + 1;
        }
        let braces = tokens.is(at, b'{');
        at = tokens.partner(at).max(at) + 1;
        if braces {
            return at;
        }
    }
    at.min(limit)
}

/// The visibility that a word before a declaration or an import says. Elsewhere the words are plain
/// identifiers.
fn visibility_at(tokens: Tokens<'_>, at: usize) -> Option<Visibility> {
    let said = match tokens.text(at) {
        "public" => Visibility::Public,
        "private" => Visibility::Private,
        _ => return None,
    };
    begins_keyword(tokens, at + 1).then_some(said)
}

/// Whether a word is the keyword of a declaration or an import.
fn begins_keyword(tokens: Tokens<'_>, at: usize) -> bool {
    KINDS.iter().any(|(name, _)| tokens.is_word(at, *name)) || tokens.is_word(at, Name::IMPORT)
}

/// Whether a declaration or an import begins at a word.
fn begins_declaration(tokens: Tokens<'_>, at: usize) -> bool {
    begins_keyword(tokens, at) || visibility_at(tokens, at).is_some()
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
            self.behind = trailing_end(tokens.text, tokens.range(at, end).end, tokens.start(end));
            at = end;
        }
    }

    fn node(&mut self, at: usize) -> Result<usize, Diagnostic> {
        if self.tokens.is(at, b';') {
            return Ok(at + 1);
        }
        if self.tokens.is(at, b'@') && self.tokens.is(at + 1, b'!') {
            return self.module_attribute(at);
        }
        let attributes = condition::read_attributes(self.module, self.tokens, at, &mut self.chain);
        if self.tokens.is(attributes.end, b'{') {
            return self.block(at, attributes);
        }
        let visibility = visibility_at(self.tokens, attributes.end);
        let keyword = attributes.end + usize::from(visibility.is_some());
        match self.tokens.word(keyword) {
            Some(Name::IMPORT) => self.import(at, attributes, visibility),
            Some(word @ (Name::ENABLE | Name::REQUIRES | Name::DIAGNOSTIC)) => {
                self.directive(keyword, word, attributes)
            }
            word => match KINDS.iter().find(|(name, _)| Some(*name) == word) {
                Some((_, kind)) => self.item(at, attributes, visibility, *kind),
                None => Err(self.tokens.expected(keyword, "a declaration")),
            },
        }
    }

    /// Reads declarations in braces, which all have the condition before the braces. The braces are
    /// removed, and the comments above them stay with the first declaration.
    fn block(&mut self, start: usize, attributes: Attributes) -> Result<usize, Diagnostic> {
        let (tokens, open) = (self.tokens, attributes.end);
        body::check_attributes(tokens, start, attributes)?;
        let condition = match attributes.condition {
            Some(condition) if attributes.conditional => condition,
            _ => {
                self.module.warnings.push(body::unreachable_braces(tokens, open));
                condition::literal_condition(self.module, false, &self.chain)
            }
        };
        let (close, first) = (tokens.partner(open), self.module.items.len());
        let head = tokens.range(start, open + 1);
        let above = leading_start(tokens.text, self.behind, head.start);
        let chain = std::mem::replace(&mut self.chain, Chain::within(Some(condition)));
        let limit = std::mem::replace(&mut self.limit, close);
        let declared = std::mem::replace(&mut self.declared, false);
        self.behind = trailing_end(tokens.text, head.end, tokens.start(open + 1));
        self.nodes(open + 1);
        (self.chain, self.limit, self.declared) = (chain, limit, declared || self.declared);
        if let Some(item) = self.module.items.get_mut(first).filter(|_| above < head.start) {
            item.events.insert(0, Event::Cut { start: head.start, end: item.range.start });
            item.range.start = above;
        }
        Ok(close + 1)
    }

    /// `@!name;` or `@!name(...);`, which says something about the whole module.
    fn module_attribute(&mut self, at: usize) -> Result<usize, Diagnostic> {
        let (tokens, name_at) = (self.tokens, at + 2);
        let name = tokens
            .word(name_at)
            .ok_or_else(|| tokens.expected(name_at, "the name of an attribute of the module"))?;
        let open = tokens.is(name_at + 1, b'(').then_some(name_at + 1);
        let end = open.map_or(name_at + 1, |open| tokens.partner(open) + 1);
        let after = tokens.expect(end, b';', "`;` after the attribute of the module")?;
        match tokens.names.text(name) {
            "wildcardable" => self.module.is_wildcardable = true,
            other => {
                let message = format!("there is no attribute `@!{other}` of modules");
                let warning = Diagnostic::warning(codes::UNKNOWN_ATTRIBUTE, message);
                let warning = warning.at(tokens.span(name_at), "has no effect");
                self.module.warnings.push(warning.suggest(other, ["wildcardable"]));
            }
        }
        Ok(after)
    }

    /// The import whose first token is `start`.
    fn import(
        &mut self,
        start: usize,
        attributes: Attributes,
        said: Option<Visibility>,
    ) -> Result<usize, Diagnostic> {
        let keyword = attributes.end + usize::from(said.is_some());
        if self.chain.within.is_some() {
            self.module.warnings.push(body::import_inside(self.tokens, keyword));
        }
        if self.declared {
            let error = Diagnostic::error(codes::SYNTAX_ERROR, "an `import` after a declaration")
                .note("help: write it above the first declaration");
            self.module
                .errors
                .push(error.at(self.tokens.span(keyword), "imports come first in a file"));
        }
        if said == Some(Visibility::Private) {
            return Err(Diagnostic::error(codes::SYNTAX_ERROR, "an `import` that is `private`")
                .at(self.tokens.span(attributes.end), "an import is for its own module anyway")
                .note("help: remove `private`"));
        }
        let statement = ImportStatement {
            condition: attributes.condition,
            is_public: said.is_some(),
            off: rules_turned_off(self.tokens, start, attributes.end),
        };
        read_import(self.module, self.tokens, keyword, statement)
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
        said: Option<Visibility>,
        kind: ItemKind,
    ) -> Result<usize, Diagnostic> {
        if let Some(visibility) = said {
            self.check_visibility(start, attributes, kind, visibility)?;
        }
        let keyword = attributes.end + usize::from(said.is_some());
        let name_at = self.name_at(keyword, kind);
        let name = match kind {
            ItemKind::ConstAssert => Name::UNDERSCORE,
            _ => self.tokens.identifier(name_at, "a name")?,
        };
        let end = self.end(keyword, kind)?;
        let text = self.tokens.text;
        let bytes = self.tokens.range(start, end);
        let mut first = leading_start(text, self.behind, bytes.start);
        if self.chain.within.is_some() {
            // In a block every line keeps its indentation, the first one included.
            first = body::line_start(text, first).max(self.behind);
        }
        self.declared = true;
        let last = trailing_end(text, bytes.end, self.tokens.start(end));
        self.module.items.push(Item {
            kind,
            visibility: said.unwrap_or(Visibility::Package),
            name,
            name_range: self.tokens.range(name_at, name_at + 1),
            range: first..last,
            condition: attributes.condition,
            entry: attributes.entry && kind == ItemKind::Function,
            events: Vec::new(),
            locals: Vec::new(),
            free: Vec::new(),
        });
        self.places.push(ItemPlace { start, attributes: attributes.end, keyword, end });
        Ok(end)
    }

    /// Refuses visibility of what has no name, or of what the host asks for by name.
    fn check_visibility(
        &self,
        start: usize,
        attributes: Attributes,
        kind: ItemKind,
        visibility: Visibility,
    ) -> Result<(), Diagnostic> {
        let is_private = visibility == Visibility::Private;
        let is_bound = || has_attribute(self.tokens, start, attributes.end, "group");
        let (message, label) = match kind {
            ItemKind::ConstAssert => {
                ("a `const_assert` cannot be `public` or `private`", "it declares no name")
            }
            ItemKind::Function if is_private && attributes.entry => {
                ("an entry point cannot be `private`", "the host could never choose it")
            }
            ItemKind::Var if is_private && is_bound() => {
                ("a variable with a binding cannot be `private`", "the host could never bind it")
            }
            _ => return Ok(()),
        };
        let error = Diagnostic::error(codes::SYNTAX_ERROR, message);
        Err(error.at(self.tokens.span(attributes.end), label))
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
                // The next declaration begins. Where its semicolon is missing, naga says so.
                _ if !braced && at > keyword + 1 && self.begins_item(at) => return Ok(at),
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

    /// Whether a word or an attribute begins a declaration.
    fn begins_item(&self, at: usize) -> bool {
        self.tokens.is(at, b'@') || begins_declaration(self.tokens, at)
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

/// What an import statement says of all that it brings.
struct ImportStatement {
    condition: Option<ConditionId>,
    is_public: bool,
    /// Rules that its `@diagnostic(off, ...)` turn off.
    off: Vec<Name>,
}

/// The rules that the attributes in `start..end` turn off.
fn rules_turned_off(tokens: Tokens<'_>, start: usize, end: usize) -> Vec<Name> {
    let is_off = |name: &usize| {
        let open = name + 1;
        tokens.is_word(*name, Name::DIAGNOSTIC)
            && tokens.is(open, b'(')
            && tokens.text(open + 1) == "off"
    };
    let rule = |name| tokens.word(name + 4);
    attribute_names(tokens, start, end).filter(is_off).filter_map(rule).collect()
}

/// Whether the attributes in `start..end` have one of the name.
fn has_attribute(tokens: Tokens<'_>, start: usize, end: usize, name: &str) -> bool {
    attribute_names(tokens, start, end).any(|at| tokens.text(at) == name)
}

/// Where the names of the attributes in `start..end` are.
fn attribute_names(
    tokens: Tokens<'_>,
    start: usize,
    end: usize,
) -> impl Iterator<Item = usize> + '_ {
    let after = move |name: usize| match tokens.is(name + 1, b'(') {
        true => tokens.partner(name + 1) + 1,
        false => name + 1,
    };
    std::iter::successors(Some(start + 1), move |name| Some(after(*name) + 1))
        .take_while(move |name| *name < end)
}

/// Reads the statement whose `import` is at `at`; returns the index past its semicolon.
fn read_import(
    module: &mut Module,
    tokens: Tokens<'_>,
    at: usize,
    statement: ImportStatement,
) -> Result<usize, Diagnostic> {
    let first = at + 1;
    let (origin, after) = read_origin(tokens, first)?;
    let nowhere = tokens.range(first, first);
    let parts =
        PathParts { first: nowhere.clone(), parents: nowhere.clone(), last: nowhere.clone() };
    let path = Path { origin, segments: Vec::new(), range: nowhere, parts };
    let mut reader = ImportReader { module, tokens, statement, at: after };
    match reader.tokens.is(after, b'{') {
        true => reader.collection(&path)?,
        false => reader.path(path, Some(first))?,
    }
    let end = reader.at;
    tokens.expect(end, b';', "`;` after the import")
}

/// `package ::`, repeated `super ::`, or nothing; and the index after it.
pub fn read_origin(tokens: Tokens<'_>, at: usize) -> Result<(Origin, usize), Diagnostic> {
    let word = tokens.word(at);
    let mut end = at;
    let mut ups = 0;
    while (word == Some(Name::PACKAGE) && end == at)
        || (word == Some(Name::SUPER) && tokens.is_word(end, Name::SUPER))
    {
        if tokens.kind(end + 1) != Some(TokenKind::Path) {
            return Err(tokens.expected(end + 1, "`::`"));
        }
        end += 2;
        ups += 1;
    }
    let origin = match word {
        Some(Name::PACKAGE) => Origin::Package,
        Some(Name::SUPER) => Origin::Super(ups),
        _ => Origin::Scope,
    };
    Ok((origin, end))
}

/// The error for `as` in the place of a name in a path.
fn misplaced_as(tokens: Tokens<'_>, at: usize) -> Diagnostic {
    let is_path = |at: usize| tokens.kind(at) == Some(TokenKind::Path);
    let error = Diagnostic::error(codes::SYNTAX_ERROR, "`as` cannot be a name in a path")
        .at(tokens.span(at), "a keyword");
    match at > 1 && is_path(at - 1) && is_path(at + 1) && tokens.word(at + 2).is_some() {
        true => {
            let (from, to) = (tokens.text(at - 2), tokens.text(at + 2));
            error.note(format!("help: without `::` around it: `{from} as {to}`"))
        }
        false => error,
    }
}

struct ImportReader<'a, 'b> {
    module: &'a mut Module,
    tokens: Tokens<'b>,
    statement: ImportStatement,
    at: usize,
}

impl ImportReader<'_, '_> {
    /// Reads `a::b::c`, `a::b as c` or `a::{...}`. This recursion is bounded, since the nesting of
    /// brackets is.
    ///
    /// `start` is the path's first token, or `None` for a path in a collection.
    fn path(&mut self, mut path: Path, start: Option<usize>) -> Result<(), Diagnostic> {
        let own = start.unwrap_or(self.at);
        loop {
            if self.tokens.is(self.at, b'*') {
                return self.wildcard(path, own);
            }
            if self.tokens.is_word(self.at, Name::AS) {
                return Err(misplaced_as(self.tokens, self.at));
            }
            let name = self.tokens.identifier(self.at, "a name")?;
            if self.tokens.text(self.at) == "self" && self.at == own && start.is_none() {
                return Err(self.own_module(&path));
            }
            let place = self.tokens.range(self.at, self.at + 1);
            if path.segments.is_empty() {
                path.parts.first = place.clone();
            } else if self.at > own {
                path.parts.parents = self.tokens.range(own, self.at - 1);
            }
            path.parts.last = place;
            path.segments.push(name);
            self.at += 1;
            if self.tokens.kind(self.at) != Some(TokenKind::Path) {
                break;
            }
            self.at += 1;
            if self.tokens.is(self.at, b'{') {
                path.parts.parents = self.tokens.range(own, self.at - 1);
                return self.collection(&path);
            }
        }
        let last = self.at - 1;
        // In a collection the place of a path is that of its last name, since the rest is shared.
        path.range = self.tokens.range(start.unwrap_or(last), last + 1);
        let mut alias_at = last;
        if self.tokens.is_word(self.at, Name::AS) {
            alias_at = self.at + 1;
            self.at += 2;
        }
        let alias = self.tokens.identifier(alias_at, "a name after `as`")?;
        let alias_range = self.tokens.range(alias_at, alias_at + 1);
        let (condition, is_public) = (self.statement.condition, self.statement.is_public);
        self.module.imports.push(Import { condition, path, alias, alias_range, is_public });
        Ok(())
    }

    /// The error about `self` in a collection, which WESL does not have.
    fn own_module(&self, path: &Path) -> Diagnostic {
        let names = path.segments.iter().map(|name| self.tokens.names.text(*name));
        let start = match path.origin {
            Origin::Package => "package::",
            _ => "",
        };
        let module = format!("{start}{}", names.collect::<Vec<_>>().join("::"));
        Diagnostic::error(codes::SYNTAX_ERROR, "WESL has no `self` in imports")
            .at(self.tokens.span(self.at), "the module itself is an import of its own")
            .note(format!("help: write `import {module};`"))
    }

    /// The `*` at the end of a path, whose first token in this piece is `own`.
    fn wildcard(&mut self, path: Path, own: usize) -> Result<(), Diagnostic> {
        let star = self.tokens.span(self.at);
        let wrong = |message: &str, label: &str| {
            Err(Diagnostic::error(codes::SYNTAX_ERROR, message).at(star, label))
        };
        if path.segments.is_empty() && path.origin == Origin::Scope {
            return wrong("a `*` without a module", "write the path of a module before it");
        }
        if self.statement.is_public {
            return wrong(
                "a `public import` of a `*`",
                "WESL has no meaning for it: name the items",
            );
        }
        let range = self.tokens.range(self.at, self.at + 1);
        let whole = match self.at > own {
            true => self.tokens.range(own, self.at - 1),
            false if path.parts.parents.is_empty() => range.clone(),
            false => path.parts.parents.clone(),
        };
        let path = Path { range: whole, ..path };
        let (condition, off) = (self.statement.condition, self.statement.off.clone());
        self.module.wildcards.push(Wildcard { condition, path, range, off });
        self.at += 1;
        Ok(())
    }

    /// `{ path, path, }`, with at least one path.
    fn collection(&mut self, prefix: &Path) -> Result<(), Diagnostic> {
        let close = self.tokens.partner(self.at);
        self.at += 1;
        loop {
            self.path(prefix.clone(), None)?;
            if self.tokens.is(self.at, b',') {
                self.at += 1;
            } else if self.at != close {
                return Err(self.tokens.expected(self.at, "`,` or `}`"));
            }
            if self.at == close {
                self.at += 1;
                return Ok(());
            }
        }
    }
}

/// Where an item's text starts: at the comments above it, if no blank line stands between.
///
/// `from` is where the item before ended, its own trailing comment included.
fn leading_start(text: &str, from: u32, start: u32) -> u32 {
    let bytes = text.as_bytes();
    let (mut at, end) = (from as usize, start as usize);
    let mut attached = None;
    let mut newlines = 0;
    while at < end {
        match bytes[at] {
            b'/' => {
                attached = if newlines > 1 { Some(at) } else { attached.or(Some(at)) };
                newlines = 0;
                at += comment_length(&text[at..end]).max(1);
            }
            byte => {
                newlines += usize::from(byte == b'\n');
                at += 1;
            }
        }
    }
    attached.filter(|_| newlines <= 1).map_or(start, |at| at as u32)
}

/// Where an item's text ends: after a comment on the same line, if nothing else follows there.
pub(crate) fn trailing_end(text: &str, end: u32, limit: u32) -> u32 {
    let rest = &text[end as usize..limit as usize];
    let line = &rest[..rest.find(['\n', '\r']).unwrap_or(rest.len())];
    let comment = line.trim_start_matches([' ', '\t']);
    if comment.starts_with("//") { end + line.trim_end().len() as u32 } else { end }
}

/// The text that is removed with a node: its whole lines, if nothing else is on them, and the `//`
/// lines above.
///
/// `before` is the end of the token before the node, and `after` is the start of the token behind
/// it.
pub(crate) fn removed_lines(text: &str, before: u32, node: Range<u32>, after: u32) -> Range<u32> {
    let head = &text[before as usize..node.start as usize];
    let end = trailing_end(text, node.end, after);
    let tail = &text[end as usize..after as usize];
    let indent = head.len() - head.trim_end_matches([' ', '\t']).len();
    let starts_line = head[..head.len() - indent].ends_with('\n');
    let blank = tail.len() - tail.trim_start_matches([' ', '\t', '\r']).len();
    match (starts_line, tail[blank..].starts_with('\n')) {
        (true, true) => {
            let start = node.start - indent as u32;
            comment_lines(text, before, start)..end + blank as u32 + 1
        }
        // At the end of a line the blanks before it are removed too; elsewhere those after it, as
        // in `f(@if(a) x, y)`.
        (false, true) => node.start - indent as u32..end,
        (_, false) => {
            node.start..end + (tail.len() - tail.trim_start_matches([' ', '\t']).len()) as u32
        }
    }
}

/// The index after the blanks that follow a removed attribute.
pub(crate) fn skip_blank(text: &str, end: u32) -> u32 {
    let rest = &text[end as usize..];
    end + (rest.len() - rest.trim_start_matches([' ', '\t', '\r', '\n']).len()) as u32
}

/// The start of the `//` lines that are directly above the line starting at `start`.
fn comment_lines(text: &str, before: u32, start: u32) -> u32 {
    let head = &text[before as usize..start as usize];
    if head.contains("/*") {
        return start;
    }
    let mut at = head.len();
    while let Some(line) = head[..at].strip_suffix('\n') {
        let Some(newline) = line.rfind('\n') else { break };
        if !line[newline + 1..].trim_start().starts_with("//") {
            break;
        }
        at = newline + 1;
    }
    before + at as u32
}
