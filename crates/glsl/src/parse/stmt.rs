//! Statements.

use super::{Failed, Parser, Res};
use crate::ast::{Cond, Stmt, StmtKind};
use crate::lexer::{Kind, mark};

impl<'a> Parser<'a, '_> {
    /// Statements up to the `}` of a block whose `{` was read.
    pub(super) fn statements(&mut self) -> Res<Vec<Stmt<'a>>> {
        let mut list = Vec::new();
        while !self.take("}") {
            if self.at_end() {
                let at = self.token().at;
                return self.fail(at, "expected `}`, found the end of the text".to_owned());
            }
            let before = self.at;
            let depth = self.depth;
            match self.statement() {
                Ok(statement) => list.push(statement),
                Err(Failed) => {
                    self.depth = depth;
                    self.skip_statement(before);
                }
            }
        }
        Ok(list)
    }

    fn statement(&mut self) -> Res<Stmt<'a>> {
        self.deeper(|parser| {
            let start = parser.token().at;
            let kind = parser.statement_kind()?;
            Ok(Stmt { kind, at: start.to(parser.last_at()) })
        })
    }

    fn statement_kind(&mut self) -> Res<StmtKind<'a>> {
        let token = self.token();
        if self.take("{") {
            return Ok(StmtKind::Block(self.statements()?));
        }
        if self.take(";") {
            return Ok(StmtKind::Nothing);
        }
        if token.kind == Kind::Word
            && let Some(kind) = self.keyword_statement()?
        {
            return Ok(kind);
        }
        self.simple_statement()
    }

    /// A declaration or an expression, with its `;`.
    fn simple_statement(&mut self) -> Res<StmtKind<'a>> {
        if self.begins_declaration() {
            return Ok(StmtKind::Item(self.item()?));
        }
        let expr = self.expression()?;
        self.expect(";")?;
        Ok(StmtKind::Expr(expr))
    }

    fn keyword_statement(&mut self) -> Res<Option<StmtKind<'a>>> {
        let word = self.text_of(self.token());
        let kind = match word {
            "if" => self.if_statement()?,
            "switch" => self.switch_statement()?,
            "for" => self.for_statement()?,
            "while" => {
                self.advance();
                self.expect("(")?;
                let condition = self.condition()?;
                self.expect(")")?;
                StmtKind::While(condition, Box::new(self.statement()?))
            }
            "do" => self.do_statement()?,
            "case" => {
                self.advance();
                let value = self.expression()?;
                self.expect(":")?;
                StmtKind::Case(Some(value))
            }
            "default" => {
                self.advance();
                self.expect(":")?;
                StmtKind::Case(None)
            }
            "return" => self.return_statement()?,
            "break" => self.jump(StmtKind::Break)?,
            "continue" => self.jump(StmtKind::Continue)?,
            "discard" | "demote" | "terminateInvocation" if self.ahead(1).kind == mark(";") => {
                self.jump(StmtKind::Discard)?
            }
            _ => return Ok(None),
        };
        Ok(Some(kind))
    }

    fn jump(&mut self, kind: StmtKind<'a>) -> Res<StmtKind<'a>> {
        self.advance();
        self.expect(";")?;
        Ok(kind)
    }

    fn return_statement(&mut self) -> Res<StmtKind<'a>> {
        self.advance();
        if self.take(";") {
            return Ok(StmtKind::Return(None));
        }
        let value = self.expression()?;
        self.expect(";")?;
        Ok(StmtKind::Return(Some(value)))
    }

    fn if_statement(&mut self) -> Res<StmtKind<'a>> {
        self.advance();
        self.expect("(")?;
        let condition = self.expression()?;
        self.expect(")")?;
        let yes = Box::new(self.statement()?);
        let no = if self.take_word("else") { Some(Box::new(self.statement()?)) } else { None };
        Ok(StmtKind::If(condition, yes, no))
    }

    fn switch_statement(&mut self) -> Res<StmtKind<'a>> {
        self.advance();
        self.expect("(")?;
        let selector = self.expression()?;
        self.expect(")")?;
        self.expect("{")?;
        Ok(StmtKind::Switch(selector, self.statements()?))
    }

    fn do_statement(&mut self) -> Res<StmtKind<'a>> {
        self.advance();
        let body = Box::new(self.statement()?);
        if !self.take_word("while") {
            let found = self.describe(self.token());
            return self.fail(self.token().at, format!("expected `while`, found {found}"));
        }
        self.expect("(")?;
        let condition = self.expression()?;
        self.expect(")")?;
        self.expect(";")?;
        Ok(StmtKind::Do(body, condition))
    }

    fn for_statement(&mut self) -> Res<StmtKind<'a>> {
        self.advance();
        self.expect("(")?;
        let start = self.token().at;
        let kind = if self.take(";") { StmtKind::Nothing } else { self.simple_statement()? };
        let first = Box::new(Stmt { kind, at: start.to(self.last_at()) });
        let condition = if self.is(";") { None } else { Some(self.condition()?) };
        self.expect(";")?;
        let step = if self.is(")") { None } else { Some(self.expression()?) };
        self.expect(")")?;
        Ok(StmtKind::For(first, condition, step, Box::new(self.statement()?)))
    }

    fn condition(&mut self) -> Res<Cond<'a>> {
        if !self.begins_declaration() {
            return Ok(Cond::Expr(self.expression()?));
        }
        let quals = self.qualifiers()?;
        let ty = self.type_spec()?;
        let declarator = self.declarator()?;
        Ok(Cond::Declared(Box::new(crate::ast::Vars { quals, ty, names: vec![declarator] })))
    }

    /// Whether a declaration begins here: qualifiers, or a type before a name.
    fn begins_declaration(&self) -> bool {
        let token = self.token();
        if token.kind != Kind::Word {
            return false;
        }
        if self.is_at_declaration() {
            return true;
        }
        let mut ahead = 1;
        while self.ahead(ahead).kind == mark("[") {
            let mut open = 0_u32;
            loop {
                let kind = self.ahead(ahead).kind;
                ahead += 1;
                match kind {
                    Kind::End => return false,
                    kind if kind == mark("[") => open += 1,
                    kind if kind == mark("]") => open -= 1,
                    _ => {}
                }
                if open == 0 {
                    break;
                }
            }
        }
        self.ahead(ahead).kind == Kind::Word
    }
}
