//! Expressions.

use lamplight_diagnostic::Diagnostic;
use lamplight_syntax::wesl::TokenKind;

use super::Reader;
use super::literal::read_number;
use super::ty::plain_type;
use crate::tree::{Argument, Binary, Callee, Expression, ExpressionKind, LineBreak, Meaning};
use crate::tree::{Scalar, Type, Unary};

/// Binary operators as marks, the longest first.
const OPERATORS: [(&str, Binary); 18] = [
    ("&&", Binary::And),
    ("||", Binary::Or),
    ("<<", Binary::ShiftLeft),
    (">>", Binary::ShiftRight),
    ("==", Binary::Equal),
    ("!=", Binary::NotEqual),
    ("<=", Binary::LessEqual),
    (">=", Binary::GreaterEqual),
    ("<", Binary::Less),
    (">", Binary::Greater),
    ("+", Binary::Add),
    ("-", Binary::Subtract),
    ("*", Binary::Multiply),
    ("/", Binary::Divide),
    ("%", Binary::Remainder),
    ("&", Binary::BitAnd),
    ("|", Binary::BitOr),
    ("^", Binary::BitXor),
];

impl Reader<'_> {
    pub fn expression(&mut self) -> Result<Expression, Diagnostic> {
        self.binary(0)
    }

    /// An expression without comparisons, as in the arguments of a template.
    pub fn additive(&mut self) -> Result<Expression, Diagnostic> {
        self.binary(10)
    }

    /// Operators that bind at least as tightly as `least`. WGSL asks for parentheses where its
    /// precedence would differ from that of C, so C's can be used.
    fn binary(&mut self, least: u8) -> Result<Expression, Diagnostic> {
        let (first, depth) = (self.at, self.depth);
        let mut left = self.unary()?;
        while let Some((operator, length)) = self.operator() {
            let (_, binding) = operator.spelling();
            if binding < least {
                break;
            }
            let line_break = match () {
                () if self.begins_line(self.at) => LineBreak::Before,
                () if self.begins_line(self.at + length) => LineBreak::After,
                () => LineBreak::None,
            };
            self.at += length;
            self.deepen()?;
            let right = self.binary(binding + 1)?;
            let (left_box, right) = (Box::new(left), Box::new(right));
            let kind = ExpressionKind::Binary { operator, left: left_box, right, line_break };
            left = Expression::new(kind, self.span_from(first));
        }
        self.depth = depth;
        Ok(left)
    }

    /// The binary operator that is next, and how many marks it has. A compound assignment is none.
    fn operator(&self) -> Option<(Binary, usize)> {
        let (marks, operator) = OPERATORS.iter().find(|(marks, _)| self.is_marks(marks))?;
        let compares = operator.compares();
        let joined = format!("{marks}=");
        (compares || !self.is_marks(&joined)).then_some((*operator, marks.len()))
    }

    /// Operators before a value, and what is behind it, such as members.
    pub fn unary(&mut self) -> Result<Expression, Diagnostic> {
        let depth = self.depth;
        let mut found = Vec::new();
        loop {
            let operator = match self.tokens.kind(self.at) {
                Some(TokenKind::Mark(b'-')) => Unary::Negate,
                Some(TokenKind::Mark(b'!')) => Unary::Not,
                Some(TokenKind::Mark(b'~')) => Unary::Complement,
                Some(TokenKind::Mark(b'&')) => Unary::Address,
                Some(TokenKind::Mark(b'*')) => Unary::Follow,
                _ => break,
            };
            found.push((operator, self.at));
            self.at += 1;
            self.deepen()?;
        }
        let mut value = self.postfix()?;
        for (operator, first) in found.into_iter().rev() {
            let kind = ExpressionKind::Unary(operator, Box::new(value));
            value = Expression::new(kind, self.span_from(first));
        }
        self.depth = depth;
        Ok(value)
    }

    fn postfix(&mut self) -> Result<Expression, Diagnostic> {
        let (first, depth) = (self.at, self.depth);
        let mut value = self.primary()?;
        loop {
            self.deepen()?;
            if self.take(b'.') {
                let name = self.identifier("a member")?;
                let kind = ExpressionKind::Member(Box::new(value), name);
                value = Expression::new(kind, self.span_from(first));
            } else if self.is(b'[') {
                self.at += 1;
                let index = self.expression()?;
                self.expect(b']')?;
                let kind = ExpressionKind::Index(Box::new(value), Box::new(index));
                value = Expression::new(kind, self.span_from(first));
            } else {
                self.depth = depth;
                return Ok(value);
            }
        }
    }

    fn primary(&mut self) -> Result<Expression, Diagnostic> {
        let first = self.at;
        if self.take(b'(') {
            let inner = self.expression()?;
            self.expect(b')')?;
            let kind = ExpressionKind::Parenthesised(Box::new(inner));
            return Ok(Expression::new(kind, self.span_from(first)));
        }
        if self.tokens.kind(self.at) == Some(TokenKind::Number) {
            self.at += 1;
            let (number, scalar) = read_number(self.tokens.text(first), self.span_from(first))?;
            let mut value = Expression::new(ExpressionKind::Number(number), self.span_from(first));
            value.ty = Type::Scalar(scalar);
            return Ok(value);
        }
        if self.is_word("true") || self.is_word("false") {
            let value = self.take_word("true");
            self.at += usize::from(!value);
            let mut value = Expression::new(ExpressionKind::Bool(value), self.span_from(first));
            value.ty = Type::Scalar(Scalar::Bool);
            return Ok(value);
        }
        self.named(first)
    }

    /// A name, an axis, or a call.
    fn named(&mut self, first: usize) -> Result<Expression, Diagnostic> {
        if self.is_template() {
            let is_bitcast = self.is_word("bitcast");
            let callee = match is_bitcast {
                true => {
                    self.at += 2;
                    let target = self.ty()?;
                    self.take(b',');
                    self.expect(b'>')?;
                    Callee::Bitcast(target)
                }
                false => Callee::Construct(self.ty()?),
            };
            return self.call(first, callee);
        }
        let path = self.path("an expression")?;
        if let Some(axis) = path.strip_prefix("constants::") {
            let kind = ExpressionKind::Axis(axis.to_owned());
            return Ok(Expression::new(kind, self.span_from(first)));
        }
        if !self.is(b'(') {
            let kind = ExpressionKind::Name(path, Meaning::Unknown);
            return Ok(Expression::new(kind, self.span_from(first)));
        }
        let callee = match plain_type(&path) {
            Some(ty) => Callee::Construct(ty),
            None => Callee::Name(path),
        };
        self.call(first, callee)
    }

    fn call(&mut self, first: usize, callee: Callee) -> Result<Expression, Diagnostic> {
        if !self.is(b'(') {
            return Err(self.tokens.expected(self.at, "`(` and the arguments"));
        }
        let close = self.partner();
        self.at += 1;
        let mut arguments = Vec::new();
        while self.at < close {
            let is_on_new_line = self.begins_line(self.at);
            arguments.push(Argument { value: self.expression()?, is_on_new_line });
            if !self.take(b',') && self.at != close {
                return Err(self.tokens.expected(self.at, "`,` or `)`"));
            }
        }
        let is_broken = self.begins_line(close);
        self.at = close + 1;
        let kind = ExpressionKind::Call { callee, arguments, is_broken };
        Ok(Expression::new(kind, self.span_from(first)))
    }
}
