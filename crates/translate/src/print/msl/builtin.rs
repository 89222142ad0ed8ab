//! Functions of WGSL as those of Metal's standard library.

use lamplight_diagnostic::Diagnostic;

use super::super::expression::{Bound, CHOICE, POSTFIX, Writer};
use crate::tree::{Argument, Expression, Type};

/// Functions beside those that both languages have by the name of WGSL, and their names in MSL.
const NAMES: &[(&str, &str)] = &[
    ("acosh", "acosh"),
    ("asinh", "asinh"),
    ("atanh", "atanh"),
    ("countLeadingZeros", "clz"),
    ("countOneBits", "popcount"),
    ("countTrailingZeros", "ctz"),
    ("dpdx", "dfdx"),
    ("dpdy", "dfdy"),
    ("faceForward", "faceforward"),
    ("fma", "fma"),
    ("fract", "fract"),
    ("inverseSqrt", "rsqrt"),
    ("mix", "mix"),
    ("reverseBits", "reverse_bits"),
    ("round", "rint"),
    ("sign", "sign"),
];

/// The name of a function that needs no special form.
pub fn function_name(wgsl: &str) -> Option<&'static str> {
    NAMES.iter().find(|(known, _)| *known == wgsl).map(|(_, name)| *name)
}

impl Writer<'_> {
    /// A call that MSL writes in a form of its own.
    pub fn msl_function(
        &self,
        name: &str,
        arguments: &[Argument],
        indent: usize,
    ) -> Result<Option<Bound>, Diagnostic> {
        let is_scalar =
            arguments.first().is_some_and(|one| matches!(one.value.ty, Type::Scalar(_)));
        Ok(match (name, arguments) {
            // 180 / pi and pi / 180.
            ("degrees" | "radians", [argument]) => {
                let text = self.operand(&argument.value, 11, indent)?;
                let by = if name == "degrees" { "57.295779513" } else { "0.01745329252" };
                Some(Bound(format!("{text} * {by}"), 11))
            }
            // The library has these of vectors.
            ("length", [argument]) if is_scalar => {
                Some(Bound(format!("abs({})", self.whole(&argument.value, indent)?), POSTFIX))
            }
            ("distance", [left, right]) if is_scalar => {
                let left = self.operand(&left.value, 10, indent)?;
                let right = self.operand(&right.value, 11, indent)?;
                Some(Bound(format!("abs({left} - {right})"), POSTFIX))
            }
            _ => None,
        })
    }

    /// `select`. A choice computes one of the values, and the function computes both.
    pub fn msl_select(
        &self,
        [reject, accept, condition]: [&Expression; 3],
        indent: usize,
    ) -> Result<Bound, Diagnostic> {
        let is_vector = matches!(condition.ty, Type::Vector(..));
        if !is_vector && self.is_repeatable(reject) && self.is_repeatable(accept) {
            let condition = self.operand(condition, 1, indent)?;
            let (accept, reject) =
                (self.operand(accept, 1, indent)?, self.operand(reject, 1, indent)?);
            return Ok(Bound(format!("{condition} ? {accept} : {reject}"), CHOICE));
        }
        let chooser = match reject.ty {
            Type::Vector(size, _) if !is_vector => {
                format!("bool{size}({})", self.whole(condition, indent)?)
            }
            _ => self.whole(condition, indent)?,
        };
        let (reject, accept) = (self.whole(reject, indent)?, self.whole(accept, indent)?);
        Ok(Bound(format!("select({reject}, {accept}, {chooser})"), POSTFIX))
    }
}
