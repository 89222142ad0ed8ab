//! Expressions.

use super::{Kind, Parsed, Parser};
use crate::syntax::{ExprId, ExprKind};
use crate::{Place, Problem, Rule};

/// What an expression is made of at its top, by which operators may stand beside it.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Level {
    Unary,
    Multiplicative,
    Additive,
    Shift,
    /// `&`, `|` and `^`, whose operands are unary.
    Bitwise,
    Relational,
    /// `&&` and `||`.
    ShortCircuit,
}

/// How tightly a binary operator binds; the loosest is 1.
fn tightness(operator: &str) -> Option<u8> {
    Some(match operator {
        "||" => 1,
        "&&" => 2,
        "|" => 3,
        "^" => 4,
        "&" => 5,
        "==" | "!=" => 6,
        "<" | ">" | "<=" | ">=" => 7,
        "<<" | ">>" => 8,
        "+" | "-" => 9,
        "*" | "/" | "%" => 10,
        _ => return None,
    })
}

impl<'t> Parser<'t> {
    pub fn expression(&mut self) -> Parsed<ExprId> {
        self.deeper(|parser| parser.binary(0).map(|(id, _)| id))
    }

    /// A sequence of expressions in round brackets.
    pub fn arguments(&mut self) -> Parsed<Vec<ExprId>> {
        self.expect("(")?;
        let mut found = Vec::new();
        while !self.is(")") {
            found.push(self.expression()?);
            if !self.take(",") {
                break;
            }
        }
        self.expect(")")?;
        Ok(found)
    }

    /// Operands with operators between them that bind at least so tightly.
    fn binary(&mut self, least: u8) -> Parsed<(ExprId, Level)> {
        let (mut left, mut left_level) = self.unary()?;
        let mut last: Option<&'t str> = None;
        loop {
            let token = self.token();
            let tightness = match token.kind {
                Kind::Mark => tightness(token.text).filter(|own| *own >= least),
                _ => None,
            };
            let Some(tightness) = tightness else { return Ok((left, left_level)) };
            let (operator, place) = (token.text, self.next().place);
            let (right, right_level) = self.binary(tightness + 1)?;
            let own = self.check_mixed(operator, last, (left_level, right_level), (left, place));
            let start = self.tree.place(left).start;
            left = self.add(ExprKind::Binary { operator, left, right }, start)?;
            left_level = own;
            last = Some(operator);
        }
    }

    /// Reports operators that may not stand beside each other without brackets, and gives the level
    /// of the whole.
    fn check_mixed(
        &mut self,
        operator: &'t str,
        last: Option<&str>,
        (left, right): (Level, Level),
        (operand, place): (ExprId, Place),
    ) -> Level {
        let (level, is_allowed) = match operator {
            "*" | "/" | "%" => (Level::Multiplicative, true),
            "+" | "-" => (Level::Additive, true),
            "<<" | ">>" => (Level::Shift, left == Level::Unary && right == Level::Unary),
            "&" | "|" | "^" => {
                let goes_on = left == Level::Bitwise && last == Some(operator);
                (Level::Bitwise, (left == Level::Unary || goes_on) && right == Level::Unary)
            }
            "&&" | "||" => {
                let goes_on = left == Level::ShortCircuit && last == Some(operator);
                let is_below =
                    |level: Level| level < Level::ShortCircuit && level != Level::Bitwise;
                (Level::ShortCircuit, (is_below(left) || goes_on) && is_below(right))
            }
            _ => (Level::Relational, left <= Level::Shift && right <= Level::Shift),
        };
        if !is_allowed {
            let message = format!("`{operator}` beside another operator needs brackets");
            let place = Place { start: self.tree.place(operand).start.min(place.start), ..place };
            let place = Place { end: self.end(), ..place };
            self.problems.push(Problem::new(Rule::Precedence, place, message));
        }
        level
    }

    fn unary(&mut self) -> Parsed<(ExprId, Level)> {
        let token = self.token();
        if token.kind != Kind::Mark {
            return Ok((self.postfix()?, Level::Unary));
        }
        let start = token.place.start;
        let kind = match token.text {
            "-" | "!" | "~" => {
                self.next();
                let operand = self.operand()?;
                ExprKind::Unary { operator: token.text, operand }
            }
            "&" => {
                self.next();
                ExprKind::AddressOf(self.operand()?)
            }
            "*" => {
                self.next();
                ExprKind::Indirection(self.operand()?)
            }
            // Two of these marks beside each other are two operators here.
            "--" | "&&" => return Ok((self.doubled(token.text)?, Level::Unary)),
            _ => return Ok((self.postfix()?, Level::Unary)),
        };
        Ok((self.add(kind, start)?, Level::Unary))
    }

    fn operand(&mut self) -> Parsed<ExprId> {
        self.deeper(|parser| parser.unary().map(|(id, _)| id))
    }

    fn doubled(&mut self, text: &'t str) -> Parsed<ExprId> {
        let place = self.next().place;
        if text == "--" {
            let message = "`--` is no operator of an expression: write `-(-x)`".to_owned();
            return Err(Problem::new(Rule::Grammar, place, message));
        }
        let operand = self.operand()?;
        let inner = self.add(ExprKind::AddressOf(operand), place.start + 1)?;
        self.add(ExprKind::AddressOf(inner), place.start)
    }

    pub fn postfix(&mut self) -> Parsed<ExprId> {
        let start = self.token().place.start;
        let mut id = self.primary()?;
        loop {
            if self.take("[") {
                let index = self.expression()?;
                self.expect("]")?;
                id = self.add(ExprKind::Index { base: id, index }, start)?;
            } else if self.take(".") {
                let name = self.word()?;
                id = self.add(ExprKind::Member { base: id, name }, start)?;
            } else {
                return Ok(id);
            }
        }
    }

    fn primary(&mut self) -> Parsed<ExprId> {
        let token = self.token();
        let start = token.place.start;
        match token.kind {
            Kind::Number => {
                self.next();
                self.add(ExprKind::Literal(token.text), start)
            }
            Kind::Word if matches!(token.text, "true" | "false") => {
                self.next();
                self.add(ExprKind::Literal(token.text), start)
            }
            Kind::Word => self.named(),
            Kind::Mark if token.text == "(" => {
                self.next();
                let inner = self.expression()?;
                self.expect(")")?;
                self.add(ExprKind::Parenthesized(inner), start)
            }
            _ => Err(self.unexpected("an expression")),
        }
    }

    /// A name, a type, or a call.
    fn named(&mut self) -> Parsed<ExprId> {
        let start = self.token().place.start;
        let name = self.word()?;
        let template = self.template()?;
        let kind = match self.is("(") {
            true => {
                if self.scope.get(name).is_some_and(|open| !open.is_empty()) {
                    let place = Place { start, end: start + name.len() as u32 };
                    let message = format!("`{name}` is no function here");
                    self.problems.push(Problem::new(Rule::Grammar, place, message));
                }
                ExprKind::Call { callee: name, template, arguments: self.arguments()? }
            }
            false => {
                let local = self.scope.get(name).and_then(|open| open.last()).copied();
                ExprKind::Name { name, template, local }
            }
        };
        self.add(kind, start)
    }

    /// The template list that may stand here.
    pub fn template(&mut self) -> Parsed<Vec<ExprId>> {
        let mut found = Vec::new();
        if self.token().kind != Kind::TemplateStart {
            return Ok(found);
        }
        self.next();
        while self.token().kind != Kind::TemplateEnd {
            found.push(self.expression()?);
            if !self.take(",") {
                break;
            }
        }
        match self.token().kind {
            Kind::TemplateEnd => self.next(),
            _ => return Err(self.missing(">")),
        };
        Ok(found)
    }

    /// A type: a name with its template list.
    pub fn type_name(&mut self) -> Parsed<ExprId> {
        let start = self.token().place.start;
        let name = self.word()?;
        let template = self.deeper(Self::template)?;
        self.add(ExprKind::Name { name, template, local: None }, start)
    }
}
