//! Parses constraints by recursive descent. It ends at the first mistake.

use super::lexer::{TokenKind, constraint_tokens};
use crate::Setting;
use crate::axis::{Axis, AxisKind, ValueSet};
use crate::key::{find_axis, find_value};
use crate::quoted::Quoted;
use crate::space::ConstraintFormula;
use lamplight_diagnostic::source::Span;
use lamplight_diagnostic::{Diagnostic, codes};

/// How deeply parentheses, negations and implications may nest.
const NESTING: usize = lamplight_files::limits::CONSTRAINT_NESTING;

/// The condition that the text states about the axes.
pub fn parse(axes: &[Axis], text: &Quoted) -> Result<ConstraintFormula, Diagnostic> {
    let mut parser =
        ConstraintParser { axes, text, tokens: constraint_tokens(&text.text), at: 0, depth: 0 };
    let formula = parser.condition()?;
    match parser.kind() {
        TokenKind::End => Ok(formula),
        _ => Err(parser.unexpected("`&&`, `||`, `=>` or the end")),
    }
}

struct ConstraintParser<'a> {
    axes: &'a [Axis],
    text: &'a Quoted,
    tokens: Vec<super::lexer::Token<'a>>,
    at: usize,
    depth: usize,
}

/// Whether `value OP bound` holds.
type Order = fn(&i64, &i64) -> bool;

/// The orders by sign.
const ORDERS: &[(&str, Order)] =
    &[("<", i64::lt), ("<=", i64::le), (">", i64::gt), (">=", i64::ge)];

/// Operators of other languages, with what to write here instead.
const HINTS: &[(&str, &str)] =
    &[("=", "=="), ("&", "&&"), ("|", "||"), ("and", "&&"), ("or", "||"), ("not", "!")];

impl<'a> ConstraintParser<'a> {
    fn condition(&mut self) -> Result<ConstraintFormula, Diagnostic> {
        self.deeper(|parser| {
            let premise = parser.series("||", ConstraintFormula::Any, |parser| {
                parser.series("&&", ConstraintFormula::All, Self::unary)
            })?;
            if !parser.take("=>") {
                return Ok(premise);
            }
            let conclusion = parser.condition()?;
            Ok(ConstraintFormula::Any(vec![ConstraintFormula::Not(Box::new(premise)), conclusion]))
        })
    }

    fn series(
        &mut self,
        sign: &str,
        join: fn(Vec<ConstraintFormula>) -> ConstraintFormula,
        mut part: impl FnMut(&mut Self) -> Result<ConstraintFormula, Diagnostic>,
    ) -> Result<ConstraintFormula, Diagnostic> {
        let first = part(self)?;
        let mut parts = vec![first];
        while self.take(sign) {
            parts.push(part(self)?);
        }
        Ok(if parts.len() == 1 { parts.remove(0) } else { join(parts) })
    }

    fn unary(&mut self) -> Result<ConstraintFormula, Diagnostic> {
        if self.take("!") {
            return self.deeper(|parser| Ok(ConstraintFormula::Not(Box::new(parser.unary()?))));
        }
        if self.take("(") {
            let inner = self.condition()?;
            self.expect(")")?;
            return Ok(inner);
        }
        self.atom()
    }

    fn atom(&mut self) -> Result<ConstraintFormula, Diagnostic> {
        if self.kind() != TokenKind::Word || self.is_keyword() {
            return Err(self.unexpected("an axis, `!` or `(`"));
        }
        let span = self.span();
        let name = self.next_text();
        let axis = find_axis(self.axes, name, span).map_err(|unknown| with_hint(unknown, name))?;
        let set = self.values_of(axis, span)?;
        Ok(ConstraintFormula::Is(axis, set))
    }

    /// The values that make the rest of an atom true.
    fn values_of(&mut self, axis: usize, span: Span) -> Result<ValueSet, Diagnostic> {
        let found = &self.axes[axis];
        let all = ValueSet::full(found.values.len());
        if self.take("==") {
            return self.value(found).map(ValueSet::single);
        }
        if self.take("!=") {
            return Ok(all.without(ValueSet::single(self.value(found)?)));
        }
        if self.kind() == TokenKind::Word && self.tokens[self.at].text == "in" {
            self.at += 1;
            return self.list(found);
        }
        match ORDERS.iter().find(|(sign, _)| self.tokens[self.at].text == *sign) {
            Some((_, holds)) => self.order(found, *holds),
            None if found.kind == AxisKind::Bool => {
                Ok(found.ordinal(&Setting::Bool(true)).into_iter().collect())
            }
            None if self.kind() == TokenKind::Stray => Err(self.unexpected("a comparison")),
            None => Err(self.bare(found, span)),
        }
    }

    fn order(&mut self, axis: &Axis, holds: Order) -> Result<ValueSet, Diagnostic> {
        let sign = self.span();
        self.at += 1;
        if axis.kind != AxisKind::Int {
            let message = format!(
                "axis `{}` is {}, and only integer axes are ordered",
                axis.name,
                with_article(axis.kind)
            );
            return Err(Diagnostic::error(codes::CONSTRAINT_TYPE, message)
                .at(sign, "compares integers")
                .at(axis.span, "declared here"));
        }
        let Some(bound) =
            self.tokens[self.at].text.parse().ok().filter(|_| self.kind() == TokenKind::Number)
        else {
            return Err(self.unexpected("an integer of 64 bits"));
        };
        self.at += 1;
        let number = |value: &Setting| matches!(value, Setting::Int(value) if holds(value, &bound));
        Ok((0..axis.values.len()).filter(|ordinal| number(&axis.values[*ordinal])).collect())
    }

    fn list(&mut self, axis: &Axis) -> Result<ValueSet, Diagnostic> {
        self.expect("[")?;
        let mut set = ValueSet::single(self.value(axis)?);
        while self.take(",") && self.tokens[self.at].text != "]" {
            set = set.or(ValueSet::single(self.value(axis)?));
        }
        self.expect("]")?;
        Ok(set)
    }

    fn value(&mut self, axis: &Axis) -> Result<usize, Diagnostic> {
        if !matches!(self.kind(), TokenKind::Word | TokenKind::Number) {
            return Err(self.unexpected(&format!("a value of `{}`", axis.name)));
        }
        let span = self.span();
        find_value(axis, &Setting::parse(self.next_text()), span)
    }

    fn bare(&self, axis: &Axis, span: Span) -> Diagnostic {
        let message = format!(
            "axis `{}` is {}, so it is not a condition by itself",
            axis.name,
            with_article(axis.kind)
        );
        let note = format!("compare it, as in `{} == {}`", axis.name, axis.values[axis.default]);
        Diagnostic::error(codes::CONSTRAINT_TYPE, message)
            .at(span, "not a boolean")
            .at(axis.span, "declared here")
            .note(note)
    }

    fn deeper<T>(
        &mut self,
        inner: impl FnOnce(&mut Self) -> Result<T, Diagnostic>,
    ) -> Result<T, Diagnostic> {
        if self.depth == NESTING {
            let message = format!("a constraint may nest {NESTING} levels deep");
            return Err(Diagnostic::error(codes::NESTING_TOO_DEEP, message)
                .at(self.span(), "one level too many"));
        }
        self.depth += 1;
        let found = inner(self);
        self.depth -= 1;
        found
    }

    fn kind(&self) -> TokenKind {
        self.tokens[self.at].kind
    }

    fn is_keyword(&self) -> bool {
        ["in", "true", "false"].contains(&self.tokens[self.at].text)
    }

    fn span(&self) -> Span {
        self.text.span(self.tokens[self.at].range.clone())
    }

    /// Returns the text of this token, which must not be the end, and steps to the next token.
    fn next_text(&mut self) -> &'a str {
        let text = self.tokens[self.at].text;
        self.at += 1;
        text
    }

    fn take(&mut self, sign: &str) -> bool {
        let found = self.kind() == TokenKind::Sign && self.tokens[self.at].text == sign;
        self.at += usize::from(found);
        found
    }

    fn expect(&mut self, sign: &str) -> Result<(), Diagnostic> {
        if self.take(sign) { Ok(()) } else { Err(self.unexpected(&format!("`{sign}`"))) }
    }

    fn unexpected(&self, expected: &str) -> Diagnostic {
        let found = match self.kind() {
            TokenKind::End => "the end".to_owned(),
            _ => format!("`{}`", self.tokens[self.at].text),
        };
        let diagnostic = Diagnostic::error(
            codes::CONSTRAINT_SYNTAX,
            format!("expected {expected}, found {found}"),
        );
        with_hint(
            diagnostic.at(self.span(), format!("expected {expected}")),
            self.tokens[self.at].text,
        )
    }
}

fn with_hint(diagnostic: Diagnostic, found: &str) -> Diagnostic {
    match HINTS.iter().find(|(wrong, _)| *wrong == found) {
        Some((_, right)) => diagnostic.note(format!("help: write `{right}`")),
        None => diagnostic,
    }
}

fn with_article(kind: AxisKind) -> String {
    match kind {
        AxisKind::Bool => "a boolean".to_owned(),
        AxisKind::Int | AxisKind::Enum => format!("an {}", kind.name()),
    }
}
