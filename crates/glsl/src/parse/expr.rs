//! Expressions, by the strength with which operators bind.

use super::{Failed, Parser, Res};
use crate::ast::{Expr, ExprKind};
use crate::lexer::{At, Kind, mark};

/// Binary operators and their strength; all of them group from the left.
const BINARY: &[(&str, u8)] = &[
    ("||", 1),
    ("^^", 2),
    ("&&", 3),
    ("|", 4),
    ("^", 5),
    ("&", 6),
    ("==", 7),
    ("!=", 7),
    ("<", 8),
    (">", 8),
    ("<=", 8),
    (">=", 8),
    ("<<", 9),
    (">>", 9),
    ("+", 10),
    ("-", 10),
    ("*", 11),
    ("/", 11),
    ("%", 11),
];

/// Assignments, with the operator that each applies.
const ASSIGN: &[(&str, &str)] = &[
    ("=", ""),
    ("+=", "+"),
    ("-=", "-"),
    ("*=", "*"),
    ("/=", "/"),
    ("%=", "%"),
    ("<<=", "<<"),
    (">>=", ">>"),
    ("&=", "&"),
    ("|=", "|"),
    ("^=", "^"),
];

impl<'a> Parser<'a, '_> {
    /// An expression with commas.
    pub(super) fn expression(&mut self) -> Res<Expr<'a>> {
        let mut left = self.assignment()?;
        while self.take(",") {
            let right = self.assignment()?;
            let at = left.at.to(right.at);
            left = Expr { kind: ExprKind::Comma(Box::new(left), Box::new(right)), at };
        }
        Ok(left)
    }

    /// An expression without commas outside of brackets.
    pub(super) fn assignment(&mut self) -> Res<Expr<'a>> {
        self.deeper(Self::assignment_within)
    }

    fn assignment_within(&mut self) -> Res<Expr<'a>> {
        let left = self.ternary()?;
        let kind = self.token().kind;
        let Some((_, op)) = ASSIGN.iter().find(|(text, _)| mark(text) == kind) else {
            return Ok(left);
        };
        self.advance();
        let right = self.assignment()?;
        let at = left.at.to(right.at);
        Ok(Expr { kind: ExprKind::Assign(op, Box::new(left), Box::new(right)), at })
    }

    fn ternary(&mut self) -> Res<Expr<'a>> {
        let condition = self.binary(0)?;
        if !self.take("?") {
            return Ok(condition);
        }
        let yes = self.deeper(Self::expression)?;
        self.expect(":")?;
        let no = self.assignment()?;
        let at = condition.at.to(no.at);
        let kind = ExprKind::Ternary(Box::new(condition), Box::new(yes), Box::new(no));
        Ok(Expr { kind, at })
    }

    fn binary(&mut self, least: u8) -> Res<Expr<'a>> {
        let mut left = self.unary()?;
        // Long sums are deep on the left, and are walked by recursion later.
        let mut length = 0;
        loop {
            let kind = self.token().kind;
            let found = BINARY.iter().find(|(text, _)| mark(text) == kind);
            let Some((op, strength)) = found.filter(|(_, strength)| *strength > least) else {
                return Ok(left);
            };
            length += 1;
            if length > 2 * super::NESTING {
                let at = self.token().at;
                return self.fail(at, "too many operators in one expression".to_owned());
            }
            self.advance();
            let right = self.deeper(|parser| parser.binary(*strength))?;
            let at = left.at.to(right.at);
            left = Expr { kind: ExprKind::Binary(op, Box::new(left), Box::new(right)), at };
        }
    }

    fn unary(&mut self) -> Res<Expr<'a>> {
        let start = self.token().at;
        for op in ["++", "--"] {
            if self.take(op) {
                let operand = self.deeper(Self::unary)?;
                let at = start.to(operand.at);
                return Ok(Expr { kind: ExprKind::Step(op, true, Box::new(operand)), at });
            }
        }
        for op in ["-", "+", "!", "~"] {
            if self.take(op) {
                let operand = self.deeper(Self::unary)?;
                let at = start.to(operand.at);
                return Ok(Expr { kind: ExprKind::Unary(op, Box::new(operand)), at });
            }
        }
        self.postfix()
    }

    fn postfix(&mut self) -> Res<Expr<'a>> {
        let mut expr = self.primary()?;
        let start = expr.at;
        for _ in 0..super::NESTING {
            let kind = if self.take("[") {
                self.index_after(expr)?
            } else if self.take("(") {
                let arguments = self.arguments(")")?;
                ExprKind::Call(Box::new(expr), arguments)
            } else if self.take(".") {
                ExprKind::Member(Box::new(expr), self.name()?)
            } else if self.take("++") {
                ExprKind::Step("++", false, Box::new(expr))
            } else if self.take("--") {
                ExprKind::Step("--", false, Box::new(expr))
            } else {
                return Ok(expr);
            };
            expr = Expr { kind, at: start.to(self.last_at()) };
        }
        self.fail(start, "too many members and indices in one expression".to_owned())
    }

    fn index_after(&mut self, expr: Expr<'a>) -> Res<ExprKind<'a>> {
        if self.take("]") {
            return Ok(ExprKind::Index(Box::new(expr), None));
        }
        let index = self.deeper(Self::expression)?;
        self.expect("]")?;
        Ok(ExprKind::Index(Box::new(expr), Some(Box::new(index))))
    }

    fn arguments(&mut self, close: &'static str) -> Res<Vec<Expr<'a>>> {
        let mut list = Vec::new();
        if self.take(close) {
            return Ok(list);
        }
        if self.is_word("void") && self.ahead(1).kind == mark(close) {
            self.at += 2;
            return Ok(list);
        }
        loop {
            list.push(self.assignment()?);
            if self.take(close) {
                return Ok(list);
            }
            self.expect(",")?;
            if close == "}" && self.take(close) {
                return Ok(list);
            }
        }
    }

    /// What a variable begins with: an expression or a list in braces.
    pub(super) fn initializer(&mut self) -> Res<Expr<'a>> {
        let start = self.token().at;
        if !self.take("{") {
            return self.assignment();
        }
        let mut list = Vec::new();
        while !self.take("}") {
            list.push(self.deeper(Self::initializer)?);
            if !self.is("}") {
                self.expect(",")?;
            }
        }
        Ok(Expr { kind: ExprKind::List(list), at: start.to(self.last_at()) })
    }

    fn primary(&mut self) -> Res<Expr<'a>> {
        let token = self.token();
        let text = self.text_of(token);
        let kind = match token.kind {
            Kind::Word => match text {
                "true" => ExprKind::Bool(true),
                "false" => ExprKind::Bool(false),
                _ => ExprKind::Name(text),
            },
            Kind::Int => ExprKind::Int(self.integer(text, token.at)?),
            Kind::Uint => ExprKind::Uint(self.integer(&text[..text.len() - 1], token.at)?),
            Kind::Float => ExprKind::Float(text),
            Kind::Double => ExprKind::Double,
            _ if self.is("(") => {
                self.advance();
                let inner = self.deeper(Self::expression)?;
                let end = self.expect(")")?;
                return Ok(Expr { kind: inner.kind, at: token.at.to(end) });
            }
            _ => {
                let found = self.describe(token);
                return self.fail(token.at, format!("expected an expression, found {found}"));
            }
        };
        self.advance();
        Ok(Expr { kind, at: token.at })
    }

    fn integer(&mut self, text: &str, at: At) -> Res<u32> {
        let lower = text.to_ascii_lowercase();
        let value = match lower.strip_prefix("0x") {
            Some(digits) => u64::from_str_radix(digits, 16),
            None if lower.len() > 1 && lower.starts_with('0') => u64::from_str_radix(&lower, 8),
            None => lower.parse::<u64>(),
        };
        match value.ok().and_then(|value| u32::try_from(value).ok()) {
            Some(value) => Ok(value),
            None => {
                self.advance();
                let _: Res<()> = self.fail(at, format!("`{text}` is not an integer of 32 bits"));
                Err(Failed)
            }
        }
    }
}
