//! Scans statements: where each ends, what it declares, and how long that is in scope.

use super::block;
use super::body::BodyScanner;
use super::condition::{self, Attributes, Chain};
use super::module::{ConditionId, Event};
use super::name::Name;
use lamplight_diagnostic::Diagnostic;

impl BodyScanner<'_, '_> {
    /// The block whose `{` is at `open`.
    pub(super) fn block(&mut self, open: usize) -> Result<(), Diagnostic> {
        let close = self.tokens.partner(open);
        let scope = self.scopes.enter();
        let mut chain = Chain::default();
        let mut at = open + 1;
        while at < close {
            at = self.node(at, close, &mut chain)?;
        }
        self.scopes.leave(scope);
        Ok(())
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
        block::check_attributes(self.tokens, start, attributes)?;
        let head = block::removed_head(self.tokens, start, open);
        self.events.push(Event::Cut { start: head.start, end: head.end });
        let (close, mark) = (self.tokens.partner(open), self.scopes.enter());
        let mut chain = Chain::within(attributes.condition);
        let mut at = open + 1;
        while at < close {
            at = self.node(at, close, &mut chain)?;
        }
        self.scopes.end_block(mark);
        let tail = block::removed_tail(self.tokens, close);
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
                let end = self.semicolon(at, limit)?;
                self.uses(at, end)?;
                Ok(end + 1)
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
        self.block(open)?;
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
        let open = self.brace(at, limit)?;
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
        let end = self.semicolon(name_at, limit)?;
        self.uses(name_at + 1, end)?;
        self.declare(name_at, condition)?;
        Ok(end + 1)
    }

    /// The index of the semicolon that ends the statement at `at`.
    fn semicolon(&self, at: usize, limit: usize) -> Result<usize, Diagnostic> {
        let mut end = at;
        while end < limit && !self.tokens.is(end, b'{') {
            if self.tokens.is(end, b';') {
                return Ok(end);
            }
            end = self.tokens.partner(end).max(end) + 1;
        }
        Err(self.tokens.expected(end.min(limit), "`;`"))
    }
}
