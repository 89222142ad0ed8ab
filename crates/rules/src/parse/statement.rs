//! Statements.

use super::{Kind, Parsed, Parser};
use crate::behaviour::{Behaviour, of_block, of_conditional_loop, of_loop, of_switch};
use crate::syntax::{
    Block, Declaration, DeclarationKind, ExprId, ExprKind, ForLoop, Local, Statement, StatementKind,
};
use crate::{Place, Problem, Rule};

/// Assignments that compute with the value before.
const COMPOUND: [&str; 10] = ["+=", "-=", "*=", "/=", "%=", "&=", "|=", "^=", "<<=", ">>="];

/// What begins a statement that has a filter of its own.
const COMPOUND_STATEMENTS: [&str; 6] = ["{", "if", "switch", "loop", "for", "while"];

impl<'t> Parser<'t> {
    /// A block with the attributes before it.
    pub fn block(&mut self) -> Parsed<Block<'t>> {
        let (_, filters) = self.attributes()?;
        let start = self.expect("{")?.start;
        let statements = self.scoped(|parser| {
            let mut statements = Vec::new();
            while !parser.is("}") {
                statements.push(parser.deeper(Self::statement)?);
            }
            Ok(statements)
        })?;
        let end = self.expect("}")?.end;
        Ok(Block { filters, statements, place: Place { start, end } })
    }

    fn statement(&mut self) -> Parsed<Statement<'t>> {
        let (place, count) = (self.token().place, self.diagnostics);
        let start = place.start;
        let (_, filters) = self.attributes()?;
        if !COMPOUND_STATEMENTS.contains(&self.token().text) {
            self.refuse_filters(count, place);
        }
        let (kind, behaviour) = self.statement_kind()?;
        let place = Place { start, end: self.end() };
        Ok(Statement { kind, filters, place, behaviour })
    }

    fn statement_kind(&mut self) -> Parsed<(StatementKind<'t>, Behaviour)> {
        let token = self.token();
        let (kind, behaviour) = match token.text {
            "{" => {
                let block = self.block()?;
                let behaviour = of_block(&block);
                return Ok((StatementKind::Block(block), behaviour));
            }
            "if" => return self.conditional(),
            "switch" => return self.switch(),
            "loop" => return self.scoped(Self::endless_loop),
            "while" => return self.while_loop(),
            "for" => return self.scoped(Self::for_loop),
            "break" if self.second().text == "if" => {
                let message = "`break if` ends a `continuing` block".to_owned();
                return Err(Problem::new(Rule::Grammar, token.place, message));
            }
            ";" => (StatementKind::Empty, Behaviour::NEXT),
            "break" => (StatementKind::Break, Behaviour::BREAK),
            "continue" => (StatementKind::Continue, Behaviour::CONTINUE),
            "discard" => (StatementKind::Discard, Behaviour::NEXT),
            "return" => {
                self.next();
                let value = match self.is(";") {
                    true => None,
                    false => Some(self.expression()?),
                };
                self.expect(";")?;
                return Ok((StatementKind::Return(value), Behaviour::RETURN));
            }
            _ => {
                let kind = self.simple()?;
                self.expect(";")?;
                return Ok((kind, Behaviour::NEXT));
            }
        };
        if token.text != ";" {
            self.next();
        }
        self.expect(";")?;
        Ok((kind, behaviour))
    }

    /// What may also begin or update a `for`.
    fn simple(&mut self) -> Parsed<StatementKind<'t>> {
        let token = self.token();
        match token.text {
            "var" => self.local(DeclarationKind::Var),
            "let" => self.local(DeclarationKind::Let),
            "const" => self.local(DeclarationKind::Const),
            "const_assert" => {
                self.next();
                self.expression().map(|_| StatementKind::Assert)
            }
            "_" => {
                self.next();
                self.expect("=")?;
                let value = self.expression()?;
                Ok(StatementKind::Assign { target: None, operator: "=", value })
            }
            _ => self.assignment(),
        }
    }

    fn assignment(&mut self) -> Parsed<StatementKind<'t>> {
        let target = match self.token().text {
            "*" | "&" => self.expression()?,
            _ => self.postfix()?,
        };
        let token = self.token();
        match token.text {
            "++" | "--" => {
                self.next();
                Ok(StatementKind::Count { target })
            }
            operator if operator == "=" || COMPOUND.contains(&operator) => {
                self.next();
                let value = self.expression()?;
                Ok(StatementKind::Assign { target: Some(target), operator, value })
            }
            _ => match self.tree.kind(target) {
                ExprKind::Call { .. } => Ok(StatementKind::Call(target)),
                _ => Err(self.missing("=")),
            },
        }
    }

    fn local(&mut self, kind: DeclarationKind) -> Parsed<StatementKind<'t>> {
        let declaration = self.declaration(kind)?;
        let constant = declaration.value.filter(|_| kind == DeclarationKind::Const);
        let local = Local { of_type: declaration.of_type, constant };
        let id = self.declare(declaration.name, local);
        Ok(StatementKind::Declare(id, declaration))
    }

    pub fn declaration(&mut self, kind: DeclarationKind) -> Parsed<Declaration<'t>> {
        self.next();
        let template = self.template()?;
        let place = self.token().place;
        let name = self.word()?;
        let of_type = match self.take(":") {
            true => Some(self.type_name()?),
            false => None,
        };
        let value = match self.take("=") {
            true => Some(self.expression()?),
            false => None,
        };
        Ok(Declaration { kind, name, place, template, of_type, value, attributes: Vec::new() })
    }

    fn conditional(&mut self) -> Parsed<(StatementKind<'t>, Behaviour)> {
        self.next();
        let condition = self.expression()?;
        let accept = self.block()?;
        let mut behaviour = of_block(&accept);
        let reject = match self.take("else") {
            false => {
                behaviour = behaviour.or(Behaviour::NEXT);
                None
            }
            true => {
                let start = self.token().place.start;
                let (kind, other) = self.deeper(|parser| match parser.is("if") {
                    true => parser.conditional(),
                    false => {
                        let block = parser.block()?;
                        let behaviour = of_block(&block);
                        Ok((StatementKind::Block(block), behaviour))
                    }
                })?;
                behaviour = behaviour.or(other);
                let place = Place { start, end: self.end() };
                let filters = Vec::new();
                Some(Box::new(Statement { kind, filters, place, behaviour: other }))
            }
        };
        Ok((StatementKind::If { condition, accept, reject }, behaviour))
    }

    fn switch(&mut self) -> Parsed<(StatementKind<'t>, Behaviour)> {
        self.next();
        let selector = self.expression()?;
        let (_, filters) = self.attributes()?;
        self.expect("{")?;
        let (mut values, mut clauses) = (Vec::new(), Vec::new());
        while !self.is("}") {
            clauses.push(self.clause(&mut values)?);
        }
        self.expect("}")?;
        let behaviour = of_switch(&clauses);
        Ok((StatementKind::Switch { selector, filters, values, clauses }, behaviour))
    }

    fn clause(&mut self, values: &mut Vec<ExprId>) -> Parsed<Block<'t>> {
        if !self.take("default") {
            self.expect("case")?;
            while !self.is(":") && !self.is("{") && !self.is("@") {
                if !self.take("default") {
                    values.push(self.expression()?);
                }
                if !self.take(",") {
                    break;
                }
            }
        }
        self.take(":");
        self.block()
    }

    fn endless_loop(&mut self) -> Parsed<(StatementKind<'t>, Behaviour)> {
        self.next();
        let (_, filters) = self.attributes()?;
        let start = self.expect("{")?.start;
        let (mut statements, mut continuing) = (Vec::new(), None);
        while !self.is("}") {
            if self.take("continuing") {
                continuing = Some(self.continuing()?);
                break;
            }
            statements.push(self.deeper(Self::statement)?);
        }
        let end = self.expect("}")?.end;
        let body = Block { filters, statements, place: Place { start, end } };
        let after = continuing.as_ref().map_or(Behaviour::NEXT, of_block);
        let behaviour = of_loop(of_block(&body), after);
        Ok((StatementKind::Loop { body, continuing }, behaviour))
    }

    fn continuing(&mut self) -> Parsed<Block<'t>> {
        let (_, filters) = self.attributes()?;
        let start = self.expect("{")?.start;
        let statements = self.scoped(Self::continuing_statements)?;
        let end = self.expect("}")?.end;
        Ok(Block { filters, statements, place: Place { start, end } })
    }

    fn continuing_statements(&mut self) -> Parsed<Vec<Statement<'t>>> {
        let mut statements = Vec::new();
        while !self.is("}") {
            if self.is("break") && self.second().text == "if" {
                let start = self.next().place.start;
                self.next();
                let kind = StatementKind::BreakIf(self.expression()?);
                self.expect(";")?;
                let place = Place { start, end: self.end() };
                let behaviour = Behaviour::BREAK.or(Behaviour::NEXT);
                statements.push(Statement { kind, filters: Vec::new(), place, behaviour });
                break;
            }
            statements.push(self.deeper(Self::statement)?);
        }
        Ok(statements)
    }

    fn while_loop(&mut self) -> Parsed<(StatementKind<'t>, Behaviour)> {
        self.next();
        let condition = self.expression()?;
        let body = self.block()?;
        let behaviour = of_conditional_loop(true, of_block(&body));
        Ok((StatementKind::While { condition, body }, behaviour))
    }

    fn for_loop(&mut self) -> Parsed<(StatementKind<'t>, Behaviour)> {
        self.next();
        self.expect("(")?;
        let start = self.for_part(";")?;
        self.expect(";")?;
        let condition = match self.is(";") {
            true => None,
            false => Some(self.expression()?),
        };
        self.expect(";")?;
        let update = self.for_part(")")?;
        self.expect(")")?;
        let body = self.block()?;
        let behaviour = of_conditional_loop(condition.is_some(), of_block(&body));
        let parts = ForLoop { start, condition, update, body };
        Ok((StatementKind::For(Box::new(parts)), behaviour))
    }

    fn for_part(&mut self, end: &str) -> Parsed<Option<Statement<'t>>> {
        if self.is(end) || self.token().kind == Kind::End {
            return Ok(None);
        }
        let start = self.token().place.start;
        let kind = self.simple()?;
        let place = Place { start, end: self.end() };
        Ok(Some(Statement { kind, filters: Vec::new(), place, behaviour: Behaviour::NEXT }))
    }
}
