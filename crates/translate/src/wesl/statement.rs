//! Statements.

use lamplight_diagnostic::Diagnostic;
use lamplight_syntax::wesl::Chain;

use super::lines::trim_blank;
use super::{Reader, new_chain};
use crate::tree::{Binary, Block, Case, Expression, ExpressionKind, Line, Local, Node, Statement};

/// Compound assignments, the longest first.
const COMPOUND: [(&str, Binary); 10] = [
    ("<<=", Binary::ShiftLeft),
    (">>=", Binary::ShiftRight),
    ("+=", Binary::Add),
    ("-=", Binary::Subtract),
    ("*=", Binary::Multiply),
    ("/=", Binary::Divide),
    ("%=", Binary::Remainder),
    ("&=", Binary::BitAnd),
    ("|=", Binary::BitOr),
    ("^=", Binary::BitXor),
];

impl Reader<'_> {
    /// A block in braces.
    pub fn block(&mut self) -> Result<Block, Diagnostic> {
        if !self.is(b'{') {
            return Err(self.tokens.expected(self.at, "`{`"));
        }
        let close = self.partner();
        self.at += 1;
        let mut chain = new_chain();
        let block = self.nodes(close, &mut chain)?;
        self.at = close + 1;
        Ok(block)
    }

    /// The statements before a closing brace.
    fn nodes(&mut self, close: usize, chain: &mut Chain) -> Result<Block, Diagnostic> {
        let mut nodes: Vec<Node<Statement>> = Vec::new();
        while self.at < close {
            let node = self.node(chain, nodes.is_empty())?;
            nodes.extend(node);
        }
        let mut end = self.lines_before(close);
        if let Some(behind) = self.comment_behind(close).filter(|_| nodes.is_empty()) {
            end.insert(0, Line::Comment(behind));
        }
        let is_blank = end.first() == Some(&Line::Blank);
        let mut end = trim_blank(end);
        if is_blank && !end.is_empty() && !nodes.is_empty() {
            end.insert(0, Line::Blank);
        }
        Ok(Block { nodes, end })
    }

    /// A statement with what is around it.
    fn node(
        &mut self,
        chain: &mut Chain,
        is_first: bool,
    ) -> Result<Option<Node<Statement>>, Diagnostic> {
        let first = self.at;
        let mut lead = self.lines_before(first);
        if is_first {
            lead.splice(0..0, self.comment_behind(first).map(Line::Comment));
            lead = trim_front(lead);
        }
        let (branch, start) = self.node_branch(chain)?;
        lead.extend(self.comments_within(first, start + usize::from(start > first)));
        self.at = start;
        let body = match (branch.is_some(), self.is(b'{')) {
            (true, true) => Statement::Group(self.block()?),
            _ => self.statement()?,
        };
        if !has_blocks(&body) {
            lead.extend(self.comments_within(start, self.at));
        }
        let trail = self.comment_behind(self.at);
        if matches!(body, Statement::Empty) && branch.is_none() && lead.is_empty() {
            return Ok(None);
        }
        Ok(Some(Node { lead, branch, body, trail, span: self.span_from(first) }))
    }

    fn statement(&mut self) -> Result<Statement, Diagnostic> {
        match self.text() {
            "{" => Ok(Statement::Block(self.block()?)),
            ";" => {
                self.at += 1;
                Ok(Statement::Empty)
            }
            "if" => self.if_statement(),
            "for" => self.for_statement(),
            "while" => {
                self.at += 1;
                Ok(Statement::While { condition: self.expression()?, body: self.block()? })
            }
            "loop" => self.loop_statement(),
            "switch" => self.switch_statement(),
            "@" => Err(self.untranslated(self.here(), "an attribute of a statement")),
            _ => {
                let simple = self.simple()?;
                self.expect(b';')?;
                Ok(simple)
            }
        }
    }

    /// A statement that ends with `;`, without that.
    fn simple(&mut self) -> Result<Statement, Diagnostic> {
        let first = self.at;
        match self.text() {
            "let" | "var" | "const" => self.local(),
            "return" => {
                self.at += 1;
                let value = (!self.is(b';')).then(|| self.expression()).transpose()?;
                Ok(Statement::Return(value))
            }
            word @ ("break" | "continue" | "discard") => {
                self.at += 1;
                Ok(match word {
                    "break" => Statement::Break,
                    "continue" => Statement::Continue,
                    _ => Statement::Discard,
                })
            }
            "const_assert" => {
                let end = self.tokens.find(first, self.tokens.len(), b';').unwrap_or(first + 1);
                self.at = end;
                let span = self.span_from(first);
                let text = &self.tokens.text[span.start as usize..span.end as usize];
                Ok(Statement::Assertion(text.to_owned()))
            }
            "_" => {
                self.at += 1;
                self.expect(b'=')?;
                Ok(Statement::Call(self.expression()?))
            }
            _ => self.assignment(),
        }
    }

    fn local(&mut self) -> Result<Statement, Diagnostic> {
        let keyword = self.text().to_owned();
        self.at += 1;
        if self.is(b'<') {
            self.at += 1;
            self.identifier("an address space")?;
            self.expect(b'>')?;
        }
        let name_at = self.at;
        let name = self.identifier("a name")?;
        let span = self.span_from(name_at);
        let ty = self.take(b':').then(|| self.ty()).transpose()?;
        let value = self.take(b'=').then(|| self.expression()).transpose()?;
        let (is_variable, is_constant) = (keyword == "var", keyword == "const");
        Ok(Statement::Local(Local { name, is_variable, is_constant, ty, value, span }))
    }

    fn assignment(&mut self) -> Result<Statement, Diagnostic> {
        let target = self.unary()?;
        for (marks, is_up) in [("++", true), ("--", false)] {
            if self.is_marks(marks) {
                self.at += 2;
                return Ok(Statement::Step { target, is_up });
            }
        }
        if let Some((marks, operator)) = COMPOUND.iter().find(|(marks, _)| self.is_marks(marks)) {
            self.at += marks.len();
            let value = self.expression()?;
            return Ok(Statement::Assign { target, operator: Some(*operator), value });
        }
        if self.take(b'=') {
            let value = self.expression()?;
            return Ok(Statement::Assign { target, operator: None, value });
        }
        match &target.kind {
            ExpressionKind::Call { .. } => Ok(Statement::Call(target)),
            _ => Err(self.tokens.expected(self.at, "an assignment or a call")),
        }
    }

    fn if_statement(&mut self) -> Result<Statement, Diagnostic> {
        self.at += 1;
        let condition = self.expression()?;
        let accept = self.block()?;
        if !self.is_word("else") {
            return Ok(Statement::If { condition, accept, reject: None });
        }
        let first = self.at;
        let lead = trim_blank(self.lines_before(first));
        self.at += 1;
        let depth = self.depth;
        self.deepen()?;
        let body = match self.is_word("if") {
            true => self.if_statement()?,
            false => Statement::Block(self.block()?),
        };
        self.depth = depth;
        let node = Node { lead, branch: None, body, trail: None, span: self.span_from(first) };
        Ok(Statement::If { condition, accept, reject: Some(Box::new(node)) })
    }

    fn for_statement(&mut self) -> Result<Statement, Diagnostic> {
        self.at += 1;
        if !self.is(b'(') {
            return Err(self.tokens.expected(self.at, "`(`"));
        }
        let close = self.partner();
        self.at += 1;
        let first = (!self.is(b';')).then(|| self.simple()).transpose()?.map(Box::new);
        self.expect(b';')?;
        let condition = (!self.is(b';')).then(|| self.expression()).transpose()?;
        self.expect(b';')?;
        let step = (self.at < close).then(|| self.simple()).transpose()?.map(Box::new);
        self.expect(b')')?;
        Ok(Statement::For { first, condition, step, body: self.block()? })
    }

    fn loop_statement(&mut self) -> Result<Statement, Diagnostic> {
        self.at += 1;
        if !self.is(b'{') {
            return Err(self.tokens.expected(self.at, "`{`"));
        }
        let close = self.partner();
        let continuing = self.own_word(close, "continuing");
        self.at += 1;
        let mut chain = new_chain();
        let body = self.nodes(continuing.unwrap_or(close), &mut chain)?;
        let mut last = (None, None);
        if continuing.is_some() {
            self.at += 1;
            last = self.continuing()?;
        }
        self.at = close + 1;
        Ok(Statement::Loop { body, continuing: last.0, break_if: last.1 })
    }

    /// The block after `continuing`, and the condition of its `break if`.
    fn continuing(&mut self) -> Result<(Option<Block>, Option<Expression>), Diagnostic> {
        if !self.is(b'{') {
            return Err(self.tokens.expected(self.at, "`{`"));
        }
        let close = self.partner();
        let break_at = self.own_word(close, "break").filter(|at| self.tokens.text(at + 1) == "if");
        self.at += 1;
        let mut chain = new_chain();
        let block = self.nodes(break_at.unwrap_or(close), &mut chain)?;
        let mut break_if = None;
        if break_at.is_some() {
            self.at += 2;
            break_if = Some(self.expression()?);
            self.expect(b';')?;
        }
        self.at = close + 1;
        Ok((Some(block), break_if))
    }

    /// Where a word is within the brackets that open here, outside of further brackets.
    fn own_word(&self, close: usize, word: &str) -> Option<usize> {
        let mut at = self.at + 1;
        while at < close {
            if self.tokens.text(at) == word {
                return Some(at);
            }
            at = self.tokens.partner(at).max(at) + 1;
        }
        None
    }

    fn switch_statement(&mut self) -> Result<Statement, Diagnostic> {
        self.at += 1;
        let selector = self.expression()?;
        if !self.is(b'{') {
            return Err(self.tokens.expected(self.at, "`{`"));
        }
        let close = self.partner();
        self.at += 1;
        let mut cases = Vec::new();
        let mut chain = new_chain();
        while self.at < close {
            let first = self.at;
            let lead = trim_blank(self.lines_before(first));
            let (branch, start) = self.node_branch(&mut chain)?;
            self.at = start;
            let body = self.case()?;
            cases.push(Node { lead, branch, body, trail: None, span: self.span_from(first) });
        }
        let end = trim_blank(self.lines_before(close));
        self.at = close + 1;
        Ok(Statement::Switch { selector, cases, end })
    }

    fn case(&mut self) -> Result<Case, Diagnostic> {
        let mut selectors = Vec::new();
        let mut is_default = self.take_word("default");
        if !is_default {
            if !self.take_word("case") {
                return Err(self.tokens.expected(self.at, "`case` or `default`"));
            }
            while !self.is(b'{') && !self.is(b':') {
                match self.take_word("default") {
                    true => is_default = true,
                    false => selectors.push(self.expression()?),
                }
                if !self.take(b',') {
                    break;
                }
            }
        }
        self.take(b':');
        Ok(Case { selectors, is_default, body: self.block()? })
    }
}

/// Whether comments within a statement have places of their own.
fn has_blocks(statement: &Statement) -> bool {
    !matches!(
        statement,
        Statement::Local(_)
            | Statement::Assign { .. }
            | Statement::Step { .. }
            | Statement::Call(_)
            | Statement::Return(_)
            | Statement::Break
            | Statement::Continue
            | Statement::Discard
            | Statement::Assertion(_)
            | Statement::Empty
    )
}

fn trim_front(lines: Vec<Line>) -> Vec<Line> {
    let first = lines.iter().position(|line| *line != Line::Blank).unwrap_or(lines.len());
    lines.into_iter().skip(first).collect()
}
