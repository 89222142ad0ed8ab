//! Operators that GLSL writes otherwise, or leaves open where WGSL says what happens.

use lamplight_diagnostic::Diagnostic;

use super::dialect::Dialect;
use super::expression::{Bound, POSTFIX, Writer};
use super::range::range_of;
use crate::tree::{Binary, Expression, ExpressionKind, NumberValue, Scalar, Type};
use crate::wesl::untranslated;

/// Comparisons of vectors, component by component.
const COMPARISONS: [(Binary, &str); 6] = [
    (Binary::Less, "lessThan"),
    (Binary::LessEqual, "lessThanEqual"),
    (Binary::Greater, "greaterThan"),
    (Binary::GreaterEqual, "greaterThanEqual"),
    (Binary::Equal, "equal"),
    (Binary::NotEqual, "notEqual"),
];

impl Writer<'_> {
    /// An operator that is not the same sign in GLSL.
    pub fn special_binary(
        &self,
        operator: Binary,
        left: &Expression,
        right: &Expression,
        indent: usize,
    ) -> Result<Option<Bound>, Diagnostic> {
        let is_vector = matches!(left.ty, Type::Vector(..)) && matches!(right.ty, Type::Vector(..));
        if (self.dialect(), operator) == (Dialect::Hlsl, Binary::Multiply)
            && let Some(product) = self.hlsl_product(left, right, indent)?
        {
            return Ok(Some(product));
        }
        let is_logical = matches!(operator, Binary::And | Binary::Or);
        if self.dialect() == Dialect::Hlsl && is_logical && self.facts.has_effects(right) {
            let what = "a call with effects behind `&&` or `||`, which HLSL always makes";
            return Err(untranslated(right.span, what));
        }
        let comparison = COMPARISONS.iter().find(|(known, _)| *known == operator);
        let is_function = is_vector && self.dialect() == Dialect::Glsl;
        if let Some((_, name)) = comparison.filter(|_| is_function) {
            let (left, right) = (self.whole(left, indent)?, self.whole(right, indent)?);
            return Ok(Some(Bound(format!("{name}({left}, {right})"), POSTFIX)));
        }
        match (operator, left.ty.scalar()) {
            (Binary::Remainder, Some(Scalar::F32)) => self.float_remainder(left, right, indent),
            (Binary::Remainder | Binary::Divide, Some(Scalar::I32 | Scalar::U32)) => {
                self.integer_division(operator, left, right, indent)
            }
            (Binary::ShiftLeft | Binary::ShiftRight, _) => {
                self.shift(operator, left, right, indent)
            }
            (Binary::BitAnd | Binary::BitOr, Some(Scalar::Bool)) => {
                match is_vector || !self.is_repeatable(right) {
                    true => Err(untranslated(
                        right.span,
                        "an operand that GLSL would not always compute",
                    )),
                    false => Ok(None),
                }
            }
            _ => Ok(None),
        }
    }

    /// Whether it makes no difference if something is computed or not.
    pub fn is_repeatable(&self, value: &Expression) -> bool {
        !self.facts.has_effects(value) && !self.facts.has_derivatives(value)
    }

    /// What is left of a float, rounded towards zero: GLSL's `mod` rounds down.
    fn float_remainder(
        &self,
        left: &Expression,
        right: &Expression,
        indent: usize,
    ) -> Result<Option<Bound>, Diagnostic> {
        for one in [left, right] {
            if !self.is_cheap(one) {
                return Err(untranslated(one.span, "an operand of `%` that is computed")
                    .note("help: give it a name: GLSL needs it twice"));
            }
        }
        let (first, by) = (self.operand(left, 10, indent)?, self.operand(right, 12, indent)?);
        let over = format!("{} / {by}", self.operand(left, 11, indent)?);
        Ok(Some(Bound(format!("{first} - {by} * trunc({over})"), 10)))
    }

    /// Whether a divisor is neither 0 nor -1 wherever it is used.
    fn is_safe_divisor(&self, value: &Expression) -> bool {
        let range = range_of(value, &self.counters);
        range.least >= 1.0 || range.most <= -2.0
    }

    /// WGSL gives the dividend for a divisor of 0, and for the least number over -1; the remainder of
    /// these is 0, and that of others has the sign of the dividend. GLSL leaves all of it open.
    fn integer_division(
        &self,
        operator: Binary,
        left: &Expression,
        right: &Expression,
        indent: usize,
    ) -> Result<Option<Bound>, Diagnostic> {
        let is_signed = left.ty.scalar() == Some(Scalar::I32);
        let is_safe = self.is_safe_divisor(right);
        let is_natural = range_of(left, &self.counters).least >= 0.0
            && range_of(right, &self.counters).least >= 0.0;
        if is_safe && (operator == Binary::Divide || !is_signed || is_natural) {
            return Ok(None);
        }
        for one in [left, right] {
            if !self.is_cheap(one) || matches!(one.ty, Type::Vector(..)) {
                let sign = operator.spelling().0;
                let what = format!("an operand of `{sign}` of integers that is computed");
                return Err(untranslated(one.span, what).note(
                    "help: give it a name: GLSL needs it twice, since it divides otherwise",
                ));
            }
        }
        let (first, by) = (self.operand(left, 11, indent)?, self.operand(right, 12, indent)?);
        let divisor = match (is_safe, is_signed) {
            (true, _) => by.clone(),
            (false, false) => format!("({by} == 0u ? 1u : {by})"),
            (false, true) => {
                let least = "-2147483647 - 1";
                format!("({by} == 0 || {first} == {least} && {by} == -1 ? 1 : {by})")
            }
        };
        if operator == Binary::Divide {
            return Ok(Some(Bound(format!("{first} / {divisor}"), 11)));
        }
        if !is_signed {
            return Ok(Some(Bound(format!("{first} % {divisor}"), 11)));
        }
        let outer = self.operand(left, 10, indent)?;
        Ok(Some(Bound(format!("{outer} - {divisor} * ({first} / {divisor})"), 10)))
    }

    /// WGSL shifts by the lowest five bits; GLSL leaves more open.
    fn shift(
        &self,
        operator: Binary,
        left: &Expression,
        right: &Expression,
        indent: usize,
    ) -> Result<Option<Bound>, Diagnostic> {
        if range_of(right, &self.counters).most < 32.0 {
            return Ok(None);
        }
        let (sign, binds) = operator.spelling();
        let first = self.operand(left, binds, indent)?;
        let count = self.operand(right, 6, indent)?;
        let mask = match right.ty {
            Type::Vector(size, _) if self.dialect() == Dialect::Glsl => {
                format!("uvec{size}(31u)")
            }
            _ => "31u".to_owned(),
        };
        Ok(Some(Bound(format!("{first} {sign} ({count} & {mask})"), binds)))
    }

    /// Whether a number is written in the text.
    pub fn literal(value: &Expression) -> Option<i64> {
        match &value.bare().kind {
            ExpressionKind::Number(number) => match number.value {
                NumberValue::Integer(value) => Some(value),
                NumberValue::Float(_) => None,
            },
            _ => None,
        }
    }
}
