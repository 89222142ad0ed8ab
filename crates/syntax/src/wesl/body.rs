//! Marks in each item what the composer must look at: conditional nodes, and uses of globals.

use std::collections::HashMap;
use std::sync::Arc;

use super::block;
use super::condition::{self, Chain};
use super::cursor::Tokens;
use super::import::read_origin;
use super::item::{ItemPlace, after_template};
use super::module::{
    ConditionId, Event, ItemKind, LocalUse, Module, Origin, Path, PathParts, UsedName,
};
use super::name::{Name, Names};
use super::scope::{IdentifierMeaning, Scopes};
use super::token::{Token, TokenKind};
use super::trivia;
use lamplight_diagnostic::Diagnostic;

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
        named: HashMap::new(),
        paths: HashMap::new(),
        scopes: Scopes::new(names.len()),
        events: Vec::new(),
        locals: Vec::new(),
        free: Vec::new(),
        traced,
        module,
    };
    for (index, place) in places.into_iter().enumerate() {
        scanner.events = std::mem::take(&mut scanner.module.items[index].events);
        let outcome = scanner.item(place, scanner.module.items[index].kind);
        scanner.scopes.leave(0);
        let item = &mut scanner.module.items[index];
        item.events = std::mem::take(&mut scanner.events);
        item.locals = sorted_names(&mut scanner.locals);
        item.free = sorted_names(&mut scanner.free);
        scanner.module.errors.extend(outcome.err());
    }
}

fn sorted_names(names: &mut Vec<Name>) -> Vec<Name> {
    names.sort_unstable();
    names.dedup();
    std::mem::take(names)
}

/// Scans one item at a time. Every method takes the index of the first token and returns the one
/// after the last. Recursion is as deep as brackets nest.
pub(super) struct BodyScanner<'a, 'b> {
    pub(super) module: &'a mut Module,
    pub(super) tokens: Tokens<'b>,
    pub(super) scopes: Scopes,
    /// By name: whether it is declared in the module's scope.
    global: Vec<bool>,
    named: HashMap<Name, u32>,
    paths: HashMap<(Origin, Vec<Name>), u32>,
    pub(super) events: Vec<Event>,
    locals: Vec<Name>,
    free: Vec<Name>,
    traced: bool,
}

impl BodyScanner<'_, '_> {
    fn item(&mut self, place: ItemPlace, kind: ItemKind) -> Result<(), Diagnostic> {
        self.attributes(place.start, place.keyword)?;
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
    pub(super) fn var_template(&mut self, at: usize) -> usize {
        let end = after_template(self.tokens, at);
        self.free.extend((at..end).filter_map(|at| self.tokens.word(at)));
        end
    }

    fn function(&mut self, open: usize, end: usize) -> Result<(), Diagnostic> {
        if !self.tokens.is(open, b'(') {
            return Err(self.tokens.expected(open, "`(` and the parameters"));
        }
        let close = self.tokens.partner(open);
        let parameters = self.fields(open, close)?;
        let body = self.brace(close + 1, end)?;
        self.uses(close + 1, body)?;
        for (at, condition) in parameters {
            self.declare(at, condition)?;
        }
        self.block(body)
    }

    fn members(&mut self, open: usize) -> Result<(), Diagnostic> {
        if !self.tokens.is(open, b'{') {
            return Err(self.tokens.expected(open, "`{` and the members"));
        }
        self.fields(open, self.tokens.partner(open)).map(drop)
    }

    /// Parameters or struct members: `attributes name : type ,`.
    fn fields(
        &mut self,
        open: usize,
        close: usize,
    ) -> Result<Vec<(usize, Option<ConditionId>)>, Diagnostic> {
        let mut fields = Vec::new();
        let mut chain = Chain::default();
        let mut at = open + 1;
        while at < close {
            let start = at;
            let attributes = condition::read_attributes(self.module, self.tokens, at, &mut chain);
            let node = self.open_node(attributes.condition);
            self.attributes(start, attributes.end)?;
            self.tokens.identifier(attributes.end, "a name")?;
            fields.push((attributes.end, attributes.condition));
            let colon = self.tokens.expect(attributes.end + 1, b':', "`:` and a type")?;
            let end = self.type_end(colon, close);
            self.uses(colon, end)?;
            at = (end + 1).min(close);
            self.close_node(node, start, at);
        }
        Ok(fields)
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
    pub(super) fn brace(&self, from: usize, limit: usize) -> Result<usize, Diagnostic> {
        self.tokens.find(from, limit, b'{').ok_or_else(|| self.tokens.expected(limit, "`{`"))
    }

    /// Declares a parameter or a local, whose name is at a token.
    pub(super) fn declare(
        &mut self,
        at: usize,
        condition: Option<ConditionId>,
    ) -> Result<(), Diagnostic> {
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
    pub(super) fn open_node(&mut self, condition: Option<ConditionId>) -> Option<usize> {
        let condition = condition?;
        self.events.push(Event::Node { condition, start: 0, end: 0, next: 0 });
        Some(self.events.len() - 1)
    }

    /// Ends a node, which has the tokens `start..end`.
    pub(super) fn close_node(&mut self, node: Option<usize>, start: usize, end: usize) {
        let Some(index) = node else { return };
        let before = self.tokens.tokens[..start].last().map_or(0, |token| token.end);
        let range = trivia::removed_lines(
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
    pub(super) fn attributes(&mut self, mut at: usize, end: usize) -> Result<(), Diagnostic> {
        while at < end {
            let arguments = self.tokens.is(at + 2, b'(').then_some(at + 2);
            let after = arguments.map_or(at + 2, |open| self.tokens.partner(open) + 1);
            if condition::is_conditional(self.tokens, at) {
                let bytes = self.tokens.range(at, after);
                self.events.push(Event::Cut {
                    start: bytes.start,
                    end: trivia::skip_blank(self.tokens.text, bytes.end),
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
    pub(super) fn uses(&mut self, mut at: usize, end: usize) -> Result<(), Diagnostic> {
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
            let message = format!("`@{}` may not stand here", self.tokens.text(at + 1));
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
            self.module.warnings.push(block::used_behind(self.tokens, at));
        }
        if self.traced {
            self.trace(at, name);
        }
        let IdentifierMeaning::Global(guard) = self.scopes.meaning(name) else { return };
        if !self.global[name.0 as usize] {
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
