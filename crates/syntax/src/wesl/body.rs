//! Marks in each item what the composer must look at: conditional nodes, and uses of globals.
//!
//! Statements are scanned for where each ends, what it declares, and how long that is in scope. A
//! scope holds the local names while a function is scanned. Braces may stand under a condition. The
//! specification flattens them: where the condition holds, their content takes the place of the whole
//! block, without the braces and the condition.

use crate::wesl::condition::{Attributes, Chain};
use crate::wesl::item::{ItemPlace, after_template, read_origin};
use crate::wesl::module::{
    ConditionId, Event, Guard, ItemKind, LocalUse, Module, Origin, Path, PathParts, UsedName,
};
use crate::wesl::token::{Name, Names, Token, TokenKind, Tokens};
use crate::wesl::{condition, item};
use lamplight_diagnostic::{Diagnostic, codes};
use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;

/// Attributes whose arguments are expressions. Words in the arguments of any other attribute name
/// nothing.
const EXPRESSION_ATTRIBUTES: &[&str] =
    &["align", "binding", "blend_src", "group", "id", "location", "size", "workgroup_size"];

/// Fills the events, locals and free names of the items at `places`.
///
/// If uses are traced, also the places that name a parameter or a local.
pub fn scan_body(
    module: &mut Module,
    tokens: &[Token],
    names: &Names,
    places: Vec<ItemPlace>,
    traced: bool,
) {
    let text = Arc::clone(&module.text);
    let tokens = Tokens { tokens, text: &text, names, source: module.source };
    let mut global = vec![false; names.len()];
    module.items.iter().for_each(|item| global[item.name.0 as usize] = true);
    module.imports.iter().for_each(|import| global[import.alias.0 as usize] = true);
    let mut scanner = BodyScanner {
        tokens,
        global,
        is_open: !module.wildcards.is_empty(),
        named: HashMap::new(),
        paths: HashMap::new(),
        scopes: Scopes::new(names.len()),
        events: Vec::new(),
        locals: Vec::new(),
        free: Vec::new(),
        traced,
        error: None,
        module,
    };
    for (index, place) in places.into_iter().enumerate() {
        scanner.events = std::mem::take(&mut scanner.module.items[index].events);
        let outcome = scanner.item(place, scanner.module.items[index].kind);
        outcome.err().into_iter().for_each(|error| scanner.fail(error));
        scanner.scopes.leave(0);
        let item = &mut scanner.module.items[index];
        item.events = std::mem::take(&mut scanner.events);
        item.locals = sorted_names(&mut scanner.locals);
        item.free = sorted_names(&mut scanner.free);
        scanner.module.errors.extend(scanner.error.take());
    }
}

fn sorted_names(names: &mut Vec<Name>) -> Vec<Name> {
    names.sort_unstable();
    names.dedup();
    std::mem::take(names)
}

/// Scans one item at a time. Every method takes the index of the first token and returns the one
/// after the last. Recursion is as deep as brackets nest.
struct BodyScanner<'a, 'b> {
    module: &'a mut Module,
    tokens: Tokens<'b>,
    scopes: Scopes,
    /// By name: whether it is declared in the module's scope.
    global: Vec<bool>,
    /// Whether the module may get any name from a wildcard.
    is_open: bool,
    named: HashMap<Name, u32>,
    paths: HashMap<(Origin, Vec<Name>), u32>,
    events: Vec<Event>,
    locals: Vec<Name>,
    free: Vec<Name>,
    traced: bool,
    /// The first error of the item. Scanning goes on with the next statement.
    error: Option<Diagnostic>,
}

impl BodyScanner<'_, '_> {
    /// Keeps the first error of an item.
    fn fail(&mut self, error: Diagnostic) {
        self.error.get_or_insert(error);
    }

    fn item(&mut self, place: ItemPlace, kind: ItemKind) -> Result<(), Diagnostic> {
        self.attributes(place.start, place.attributes)?;
        if place.attributes < place.keyword {
            let bytes = self.tokens.range(place.attributes, place.keyword);
            let end = item::skip_blank(self.tokens.text, bytes.end);
            self.events.push(Event::Cut { start: bytes.start, end });
        }
        let mut at = place.keyword + 1;
        if kind == ItemKind::Var {
            at = self.var_template(at);
        }
        if kind != ItemKind::ConstAssert {
            let token = self.tokens.tokens[at];
            self.events.push(Event::Definition { start: token.start, end: token.end });
            at += 1;
        }
        match kind {
            ItemKind::Function => self.function(at, place.end),
            ItemKind::Struct => self.members(at),
            _ => self.uses(at, place.end),
        }
    }

    /// Skips the `<storage, read>` of a `var`. Compilers treat these words as predeclared, whatever
    /// the module declares by their names.
    fn var_template(&mut self, at: usize) -> usize {
        let end = after_template(self.tokens, at);
        self.free.extend((at..end).filter_map(|at| self.tokens.word(at)));
        end
    }

    fn function(&mut self, open: usize, end: usize) -> Result<(), Diagnostic> {
        if !self.tokens.is(open, b'(') {
            return Err(self.tokens.expected(open, "`(` and the parameters"));
        }
        let close = self.tokens.partner(open);
        let parameters = self.fields(open, close);
        let body = self.brace(close + 1, end)?;
        self.uses(close + 1, body).err().into_iter().for_each(|error| self.fail(error));
        for (at, condition) in parameters {
            self.declare(at, condition)?;
        }
        self.block(body);
        Ok(())
    }

    fn members(&mut self, open: usize) -> Result<(), Diagnostic> {
        if !self.tokens.is(open, b'{') {
            return Err(self.tokens.expected(open, "`{` and the members"));
        }
        self.fields(open, self.tokens.partner(open));
        Ok(())
    }

    /// Parameters or struct members: `attributes name : type ,`.
    fn fields(&mut self, open: usize, close: usize) -> Vec<(usize, Option<ConditionId>)> {
        let mut fields = Vec::new();
        let mut chain = Chain::default();
        let mut at = open + 1;
        while at < close {
            let start = at;
            let attributes = condition::read_attributes(self.module, self.tokens, at, &mut chain);
            let node = self.open_node(attributes.condition);
            if let Err(error) = self.field(start, attributes, close, &mut fields) {
                self.fail(error);
            }
            at = (self.type_end(attributes.end, close) + 1).min(close);
            self.close_node(node, start, at);
        }
        fields
    }

    fn field(
        &mut self,
        start: usize,
        attributes: Attributes,
        close: usize,
        fields: &mut Vec<(usize, Option<ConditionId>)>,
    ) -> Result<(), Diagnostic> {
        self.attributes(start, attributes.end)?;
        self.tokens.identifier(attributes.end, "a name")?;
        fields.push((attributes.end, attributes.condition));
        let colon = self.tokens.expect(attributes.end + 1, b':', "`:` and a type")?;
        self.uses(colon, self.type_end(colon, close))
    }

    /// The comma or bracket that ends a type: commas in `<...>` are part of it.
    fn type_end(&self, from: usize, close: usize) -> usize {
        let mut at = from;
        let mut depth = 0i32;
        while at < close {
            match self.tokens.kind(at) {
                Some(TokenKind::Mark(b'<')) => depth += 1,
                Some(TokenKind::Mark(b'>')) => depth -= 1,
                Some(TokenKind::Mark(b',')) if depth <= 0 => return at,
                _ => at = self.tokens.partner(at).max(at),
            }
            at += 1;
        }
        close
    }

    /// The `{` that starts a body after `from`.
    fn brace(&self, from: usize, limit: usize) -> Result<usize, Diagnostic> {
        let mut at = from;
        while at < limit && !self.tokens.is(at, b'{') {
            if self.tokens.is(at, b';') || self.begins_statement(at) {
                return Err(self.tokens.expected(at, "`{`"));
            }
            at = self.tokens.partner(at).max(at) + 1;
        }
        if at < limit { Ok(at) } else { Err(self.tokens.expected(limit, "`{`")) }
    }

    /// Declares a parameter or a local, whose name is at a token.
    fn declare(&mut self, at: usize, condition: Option<ConditionId>) -> Result<(), Diagnostic> {
        let name = self.tokens.identifier(at, "a name")?;
        self.locals.push(name);
        self.scopes.declare(self.module, (name, self.tokens.start(at)), condition);
        self.trace(at, name);
        Ok(())
    }

    /// Notes a place that names a local, if uses are traced.
    fn trace(&mut self, at: usize, name: Name) {
        if let Some(declared) = self.scopes.place(name).filter(|_| self.traced) {
            let Token { start, end, .. } = self.tokens.tokens[at];
            self.module.local_uses.push(LocalUse { declared, start, end });
        }
    }

    /// Begins a conditional node. What this returns is given to `close_node`.
    fn open_node(&mut self, condition: Option<ConditionId>) -> Option<usize> {
        let condition = condition?;
        self.events.push(Event::Node { condition, start: 0, end: 0, next: 0 });
        Some(self.events.len() - 1)
    }

    /// Ends a node, which has the tokens `start..end`.
    fn close_node(&mut self, node: Option<usize>, start: usize, end: usize) {
        let Some(index) = node else { return };
        let before = self.tokens.tokens[..start].last().map_or(0, |token| token.end);
        let range = item::removed_lines(
            self.tokens.text,
            before,
            self.tokens.range(start, end),
            self.tokens.start(end),
        );
        let following = self.events.len() as u32;
        if let Event::Node { start, end, next, .. } = &mut self.events[index] {
            (*start, *end, *next) = (range.start, range.end, following);
        }
    }

    /// Marks the attributes in `at..end`: cuts translate-time attributes, and looks into
    /// expressions.
    fn attributes(&mut self, mut at: usize, end: usize) -> Result<(), Diagnostic> {
        while at < end {
            let arguments = self.tokens.is(at + 2, b'(').then_some(at + 2);
            let after = arguments.map_or(at + 2, |open| self.tokens.partner(open) + 1);
            if condition::is_conditional(self.tokens, at) {
                let bytes = self.tokens.range(at, after);
                self.events.push(Event::Cut {
                    start: bytes.start,
                    end: item::skip_blank(self.tokens.text, bytes.end),
                });
            } else if let Some(open) =
                arguments.filter(|_| EXPRESSION_ATTRIBUTES.contains(&self.tokens.text(at + 1)))
            {
                self.uses(open + 1, after - 1)?;
            }
            at = after;
        }
        Ok(())
    }

    /// Marks the globals that the expression or type in `at..end` uses.
    fn uses(&mut self, mut at: usize, end: usize) -> Result<(), Diagnostic> {
        while at < end {
            at = match self.tokens.kind(at) {
                Some(TokenKind::Word(name)) => self.word(at, name)?,
                Some(TokenKind::Mark(b'@')) => self.stray_attribute(at)?,
                _ => at + 1,
            };
        }
        Ok(())
    }

    /// An attribute among other things: of a return type or a body.
    fn stray_attribute(&mut self, at: usize) -> Result<usize, Diagnostic> {
        if condition::is_conditional(self.tokens, at) {
            let message = format!("`@{}` is not allowed here", self.tokens.text(at + 1));
            return Err(condition::illegal_attribute(
                self.tokens,
                at + 1,
                &message,
                "what follows cannot be removed on its own",
            ));
        }
        let arguments = self.tokens.is(at + 2, b'(').then_some(at + 2);
        let after = arguments.map_or(at + 2, |open| self.tokens.partner(open) + 1);
        self.attributes(at, after)?;
        Ok(after)
    }

    fn word(&mut self, at: usize, name: Name) -> Result<usize, Diagnostic> {
        let member = at > 0 && self.tokens.is(at - 1, b'.');
        let path = self.tokens.kind(at + 1) == Some(TokenKind::Path);
        match name {
            _ if member => Ok(at + 1),
            Name::PACKAGE | Name::SUPER => self.path(at),
            _ if name.is_keyword() => Ok(at + 1),
            _ if path => self.path(at),
            _ => {
                self.name(at, name);
                Ok(at + 1)
            }
        }
    }

    fn name(&mut self, at: usize, name: Name) {
        if self.scopes.is_behind_block(name) {
            self.module.warnings.push(used_behind(self.tokens, at));
        }
        if self.traced {
            self.trace(at, name);
        }
        let IdentifierMeaning::Global(guard) = self.scopes.meaning(name) else { return };
        if !self.global[name.0 as usize] && !self.is_open {
            self.free.push(name);
            return;
        }
        let next = self.module.references.len() as u32;
        let reference = *self.named.entry(name).or_insert(next);
        if reference == next {
            self.module.references.push(UsedName::Name(name));
        }
        let token = self.tokens.tokens[at];
        self.events.push(Event::Use { reference, guard, start: token.start, end: token.end });
    }

    fn path(&mut self, at: usize) -> Result<usize, Diagnostic> {
        let (origin, mut end) = read_origin(self.tokens, at)?;
        let first = end;
        let mut segments = Vec::new();
        loop {
            segments.push(self.tokens.identifier(end, "a name")?);
            end += 1;
            if self.tokens.kind(end) != Some(TokenKind::Path) {
                break;
            }
            end += 1;
        }
        let range = self.tokens.range(at, end);
        let parts = PathParts {
            first: self.tokens.range(first, first + 1),
            parents: self.tokens.range(at, end.saturating_sub(2).max(at)),
            last: self.tokens.range(end - 1, end),
        };
        let next = self.module.references.len() as u32;
        let reference = *self.paths.entry((origin, segments.clone())).or_insert(next);
        if reference == next {
            self.module.references.push(UsedName::Path(Path {
                origin,
                segments,
                range: range.clone(),
                parts,
            }));
        }
        self.events.push(Event::Use { reference, guard: None, start: range.start, end: range.end });
        Ok(end)
    }
}

impl BodyScanner<'_, '_> {
    /// The block whose `{` is at `open`.
    fn block(&mut self, open: usize) {
        let scope = self.scopes.enter();
        self.nodes(open + 1, self.tokens.partner(open), Chain::default());
        self.scopes.leave(scope);
    }

    /// The statements up to a brace. After one with an error, they go on with the next one.
    fn nodes(&mut self, from: usize, close: usize, mut chain: Chain) {
        let mut at = from;
        while at < close {
            let (events, uses) = (self.events.len(), self.module.local_uses.len());
            at = match self.node(at, close, &mut chain) {
                Ok(end) => end,
                Err(error) => {
                    self.fail(error);
                    let end = self.next_statement(at, close);
                    if (self.events.len(), self.module.local_uses.len()) == (events, uses) {
                        // Editors ask for what it names all the same.
                        self.uses(at, end).err().into_iter().for_each(|error| self.fail(error));
                    }
                    self.close_nodes(events, at, end);
                    end
                }
            };
        }
    }

    /// The first token behind a statement with an error: that of the next statement or block.
    fn next_statement(&self, from: usize, limit: usize) -> usize {
        let mut at = from;
        while at < limit {
            if at > from && (self.begins_statement(at) || self.tokens.is(at, b'{')) {
                return at;
            }
            if self.tokens.is(at, b';') {
                return at + 1;
            }
            at = self.tokens.partner(at).max(at) + 1;
        }
        limit
    }

    /// Whether a word begins a statement, though what is before it is not ended.
    fn begins_statement(&self, at: usize) -> bool {
        let is_inner =
            at > 0 && (self.tokens.is(at - 1, b'@') || self.tokens.is_word(at - 1, Name::BREAK));
        !is_inner && self.tokens.word(at).is_some_and(Name::begins_statement)
    }

    /// Ends the conditional nodes that an error left open.
    fn close_nodes(&mut self, first: usize, start: usize, end: usize) {
        for index in first..self.events.len() {
            if matches!(self.events[index], Event::Node { next: 0, .. }) {
                self.close_node(Some(index), start, end);
            }
        }
    }

    /// A statement with its attributes.
    fn node(&mut self, at: usize, limit: usize, chain: &mut Chain) -> Result<usize, Diagnostic> {
        let attributes = condition::read_attributes(self.module, self.tokens, at, chain);
        let node = self.open_node(attributes.condition.filter(|_| attributes.conditional));
        let end = if node.is_some() && self.tokens.is(attributes.end, b'{') {
            self.flat_block(at, attributes)?
        } else {
            self.attributes(at, attributes.end)?;
            self.statement(attributes.end, limit, attributes.condition)?
        };
        self.close_node(node, at, end);
        Ok(end)
    }

    /// Statements in braces under a condition, which are not a scope of their own.
    fn flat_block(&mut self, start: usize, attributes: Attributes) -> Result<usize, Diagnostic> {
        let open = attributes.end;
        check_attributes(self.tokens, start, attributes)?;
        let head = removed_head(self.tokens, start, open);
        self.events.push(Event::Cut { start: head.start, end: head.end });
        let (close, mark) = (self.tokens.partner(open), self.scopes.enter());
        self.nodes(open + 1, close, Chain::within(attributes.condition));
        self.scopes.end_block(mark);
        let tail = removed_tail(self.tokens, close);
        self.events.push(Event::Cut { start: tail.start.max(head.end), end: tail.end });
        Ok(close + 1)
    }

    fn statement(
        &mut self,
        at: usize,
        limit: usize,
        condition: Option<ConditionId>,
    ) -> Result<usize, Diagnostic> {
        if at >= limit {
            return Err(self.tokens.expected(at, "a statement"));
        }
        match self.tokens.word(at) {
            Some(Name::IF) => self.if_chain(at, limit),
            Some(Name::SWITCH) => self.switch(at, limit),
            Some(Name::FOR) => self.for_loop(at, limit),
            Some(Name::LOOP | Name::WHILE | Name::CONTINUING) => self.headed_block(at + 1, limit),
            Some(Name::LET | Name::CONST | Name::VAR) => self.local(at, limit, condition),
            Some(Name::ELSE) => Err(self.misplaced_else(at)),
            _ if self.tokens.is(at, b'{') => self.headed_block(at, limit),
            _ => {
                let (end, next) = self.semicolon(at, limit)?;
                self.uses(at, end)?;
                Ok(next)
            }
        }
    }

    fn misplaced_else(&self, at: usize) -> Diagnostic {
        let conditional = at > 0 && !self.tokens.is(at - 1, b'}');
        match conditional {
            true => condition::illegal_attribute(
                self.tokens,
                at,
                "an `else` clause cannot be conditional",
                "belongs to the `if` before it",
            )
            .note("help: make the whole `if` statement conditional"),
            false => self.tokens.expected(at, "a statement"),
        }
    }

    /// An expression or nothing, and then a block.
    fn headed_block(&mut self, at: usize, limit: usize) -> Result<usize, Diagnostic> {
        let open = self.brace(at, limit)?;
        self.uses(at, open)?;
        self.block(open);
        Ok(self.tokens.partner(open) + 1)
    }

    fn if_chain(&mut self, at: usize, limit: usize) -> Result<usize, Diagnostic> {
        let mut end = self.headed_block(at + 1, limit)?;
        while self.tokens.is_word(end, Name::ELSE) {
            let head = if self.tokens.is_word(end + 1, Name::IF) { end + 2 } else { end + 1 };
            end = self.headed_block(head, limit)?;
        }
        Ok(end)
    }

    fn switch(&mut self, at: usize, limit: usize) -> Result<usize, Diagnostic> {
        let open = self.brace(at + 1, limit)?;
        self.uses(at + 1, open)?;
        let close = self.tokens.partner(open);
        let mut chain = Chain::default();
        let mut clause = open + 1;
        while clause < close {
            let attributes =
                condition::read_attributes(self.module, self.tokens, clause, &mut chain);
            let node = self.open_node(attributes.condition);
            self.attributes(clause, attributes.end)?;
            if !matches!(self.tokens.word(attributes.end), Some(Name::CASE | Name::DEFAULT)) {
                return Err(self.tokens.expected(attributes.end, "`case` or `default`"));
            }
            let end = self.headed_block(attributes.end + 1, close)?;
            self.close_node(node, clause, end);
            clause = end;
        }
        Ok(close + 1)
    }

    /// What the header of a `for` declares is in scope in the header and the body.
    fn for_loop(&mut self, at: usize, limit: usize) -> Result<usize, Diagnostic> {
        let open = self.tokens.expect(at + 1, b'(', "`(`")? - 1;
        let close = self.tokens.partner(open);
        let scope = self.scopes.enter();
        let first = open + 1;
        let rest = match self.tokens.word(first) {
            Some(Name::LET | Name::CONST | Name::VAR) => self.local(first, close, None)?,
            _ => first,
        };
        self.uses(rest, close)?;
        let end = self.headed_block(close + 1, limit)?;
        self.scopes.leave(scope);
        Ok(end)
    }

    /// `let`, `const` or `var`: in scope after its semicolon.
    fn local(
        &mut self,
        at: usize,
        limit: usize,
        condition: Option<ConditionId>,
    ) -> Result<usize, Diagnostic> {
        let name_at = self.var_template(at + 1);
        self.tokens.identifier(name_at, "a name")?;
        let ending = self.semicolon(name_at, limit);
        let end = match &ending {
            Ok((end, _)) => *end,
            Err(_) => self.next_statement(name_at, limit),
        };
        self.uses(name_at + 1, end)?;
        self.declare(name_at, condition)?;
        ending.map(|(_, next)| next)
    }

    /// The end of the statement at `at`, and the start of what follows: behind its semicolon, or a
    /// word that begins the next statement, where naga reports that the semicolon is missing.
    fn semicolon(&self, at: usize, limit: usize) -> Result<(usize, usize), Diagnostic> {
        let mut end = at;
        while end < limit && !self.tokens.is(end, b'{') {
            if self.tokens.is(end, b';') {
                return Ok((end, end + 1));
            }
            if end > at && self.begins_statement(end) {
                return Ok((end, end));
            }
            end = self.tokens.partner(end).max(end) + 1;
        }
        Err(self.tokens.expected(end.min(limit), "`;`"))
    }
}

/// What an identifier may mean.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum IdentifierMeaning {
    /// A local, whatever the settings.
    Local,
    /// Something global, unless a guard in the chain holds.
    Global(Option<u32>),
}

/// The declarations in scope. Looking a name up takes constant time.
#[derive(Debug, Default)]
struct Scopes {
    declarations: Vec<ScopedName>,
    /// By name: one more than the index of its innermost declaration.
    innermost: Vec<u32>,
}

#[derive(Debug, Clone, Copy)]
struct ScopedName {
    name: Name,
    meaning: IdentifierMeaning,
    /// The value in `innermost` before this declaration.
    outer: u32,
    /// Whether it was declared in the braces of a condition that have ended. Its first use gets a
    /// warning.
    behind_block: bool,
    /// First byte of the name.
    place: u32,
}

impl Scopes {
    /// No declarations. Names are below `names`.
    pub fn new(names: usize) -> Self {
        Self { declarations: Vec::new(), innermost: vec![0; names] }
    }

    /// Begins a scope. Calling `leave` with the returned mark ends it and removes its declarations.
    pub fn enter(&self) -> usize {
        self.declarations.len()
    }

    pub fn leave(&mut self, mark: usize) {
        while self.declarations.len() > mark {
            if let Some(declaration) = self.declarations.pop() {
                self.innermost[declaration.name.0 as usize] = declaration.outer;
            }
        }
    }

    pub fn declare(
        &mut self,
        module: &mut Module,
        (name, place): (Name, u32),
        condition: Option<ConditionId>,
    ) {
        let meaning = match (condition, self.meaning(name)) {
            (None, _) | (_, IdentifierMeaning::Local) => IdentifierMeaning::Local,
            (Some(condition), IdentifierMeaning::Global(next)) => {
                module.guards.push(Guard { condition, next });
                IdentifierMeaning::Global(Some(module.guards.len() as u32 - 1))
            }
        };
        let outer = std::mem::replace(
            &mut self.innermost[name.0 as usize],
            self.declarations.len() as u32 + 1,
        );
        self.declarations.push(ScopedName { name, meaning, outer, behind_block: false, place });
    }

    /// Ends the braces of a condition. What was declared in them stays in scope.
    pub fn end_block(&mut self, mark: usize) {
        self.declarations[mark..].iter_mut().for_each(|found| found.behind_block = true);
    }

    /// Whether a name means a local from a conditional block that has ended. It is true only once
    /// for each declaration.
    pub fn is_behind_block(&mut self, name: Name) -> bool {
        let index = self.innermost[name.0 as usize].checked_sub(1);
        let found = index.and_then(|index| self.declarations.get_mut(index as usize));
        found.is_some_and(|found| std::mem::take(&mut found.behind_block))
    }

    /// Where the local of a name is declared.
    pub fn place(&self, name: Name) -> Option<u32> {
        let index = self.innermost[name.0 as usize].checked_sub(1)?;
        Some(self.declarations[index as usize].place)
    }

    pub fn meaning(&self, name: Name) -> IdentifierMeaning {
        match self.innermost[name.0 as usize] {
            0 => IdentifierMeaning::Global(None),
            index => self.declarations[index as usize - 1].meaning,
        }
    }
}

/// Checks the attributes of a block: only a condition is allowed.
pub(crate) fn check_attributes(
    tokens: Tokens<'_>,
    start: usize,
    attributes: Attributes,
) -> Result<(), Diagnostic> {
    let open = attributes.end;
    let arguments = tokens.is(start + 2, b'(').then_some(start + 2);
    let first = arguments.map_or(start + 2, |open| tokens.partner(open) + 1);
    if start == open || (condition::is_conditional(tokens, start) && first == open) {
        return Ok(());
    }
    let odd = if condition::is_conditional(tokens, start) { first } else { start };
    let message = format!("a block of declarations has the attribute `@{}`", tokens.text(odd + 1));
    Err(Diagnostic::error(codes::SYNTAX_ERROR, message)
        .at(tokens.span(odd + 1), "only a condition may precede a block"))
}

/// The warning about braces without a condition.
pub(crate) fn unreachable_braces(tokens: Tokens<'_>, open: usize) -> Diagnostic {
    let message = "a block of declarations without a condition";
    Diagnostic::warning(codes::BLOCK_READING, message)
        .at(tokens.span(open), "what is in these braces is in no permutation")
        .note("help: write `@if(...)` before it, or remove the braces")
}

/// The warning about an import that other tools do not read.
pub(crate) fn import_inside(tokens: Tokens<'_>, keyword: usize) -> Diagnostic {
    Diagnostic::warning(codes::BLOCK_READING, "an `import` in a block")
        .at(tokens.span(keyword), "other tools refuse it here")
        .note("help: write the condition before each `import` at the top of the file")
}

/// The warning about a local that is used behind the block it is declared in.
fn used_behind(tokens: Tokens<'_>, at: usize) -> Diagnostic {
    let message = format!("`{}` is declared in a conditional block before this", tokens.text(at));
    Diagnostic::warning(codes::BLOCK_READING, message)
        .at(tokens.span(at), "in scope here, since the braces of `@if(...) { }` are not a scope")
        .note("tools that are older than this rule end its scope at the `}`")
}

/// The text of a flattened block's head that is removed: from its first attribute to the brace, and
/// whole lines if nothing else is on them.
fn removed_head(tokens: Tokens<'_>, start: usize, open: usize) -> Range<u32> {
    let text = tokens.text;
    let bytes = tokens.range(start, open + 1);
    let end = item::trailing_end(text, bytes.end, tokens.start(open + 1));
    let start = line_start(text, bytes.start);
    match line_end(text, end) {
        Some(after) if at_line_start(text, start) => start..after,
        _ => bytes.start..item::skip_blank(text, end),
    }
}

/// The text that is removed with the closing brace of a flattened block: its whole line, if nothing
/// else is on it.
fn removed_tail(tokens: Tokens<'_>, close: usize) -> Range<u32> {
    let text = tokens.text;
    let bytes = tokens.range(close, close + 1);
    let start = line_start(text, bytes.start);
    let alone = at_line_start(text, start);
    let end = item::trailing_end(text, bytes.end, tokens.start(close + 1));
    match line_end(text, end) {
        Some(after) if alone => start..after,
        // `} @else {`: the line break before it is removed, and the one after it stays.
        _ if alone => start - line_break(&text[..start as usize])..bytes.end,
        _ => bytes.start - blanks_before(text, bytes.start)..bytes.end,
    }
}

/// The start of the line, if only blanks stand before the byte; else the byte itself.
pub(crate) fn line_start(text: &str, byte: u32) -> u32 {
    let start = byte - blanks_before(text, byte);
    if at_line_start(text, start) { start } else { byte }
}

fn blanks_before(text: &str, byte: u32) -> u32 {
    let head = &text[..byte as usize];
    (head.len() - head.trim_end_matches([' ', '\t']).len()) as u32
}

fn at_line_start(text: &str, byte: u32) -> bool {
    byte == 0 || text[..byte as usize].ends_with('\n')
}

/// The end of the line, if only blanks stand before that.
fn line_end(text: &str, byte: u32) -> Option<u32> {
    let rest = &text[byte as usize..];
    let blank = rest.len() - rest.trim_start_matches([' ', '\t', '\r']).len();
    rest[blank..].starts_with('\n').then(|| byte + blank as u32 + 1)
}

/// Length of the line break at the end of the text.
fn line_break(text: &str) -> u32 {
    if text.ends_with("\r\n") { 2 } else { u32::from(text.ends_with('\n')) }
}
