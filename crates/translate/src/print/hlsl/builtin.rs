//! Functions of WGSL as those of HLSL.

use lamplight_diagnostic::Diagnostic;

use super::super::expression::{Bound, CHOICE, POSTFIX, Writer};
use crate::tree::{Argument, Expression, Scalar, Type};

/// Functions beside those that both languages have by the name of WGSL, and their names in HLSL.
const NAMES: &[(&str, &str)] = &[
    ("degrees", "degrees"),
    ("dpdx", "ddx"),
    ("dpdxCoarse", "ddx_coarse"),
    ("dpdxFine", "ddx_fine"),
    ("dpdy", "ddy"),
    ("dpdyCoarse", "ddy_coarse"),
    ("dpdyFine", "ddy_fine"),
    ("faceForward", "faceforward"),
    ("fma", "mad"),
    ("fract", "frac"),
    ("inverseSqrt", "rsqrt"),
    ("mix", "lerp"),
    ("radians", "radians"),
    ("round", "round"),
];

/// The name of a function that needs no special form.
pub fn function_name(wgsl: &str) -> Option<&'static str> {
    NAMES.iter().find(|(known, _)| *known == wgsl).map(|(_, name)| *name)
}

impl Writer<'_> {
    /// A call that HLSL writes in a form of its own.
    pub fn hlsl_function(
        &self,
        name: &str,
        arguments: &[Argument],
        value: &Expression,
        indent: usize,
    ) -> Result<Option<Bound>, Diagnostic> {
        let whole = |index: usize| self.whole(&arguments[index].value, indent);
        Ok(match (name, arguments) {
            // HLSL gives integers.
            ("sign", [_]) if value.ty.scalar() == Some(Scalar::F32) => {
                let ty = self.names.type_name(&value.ty, value.span)?;
                Some(Bound(format!("{ty}(sign({}))", whole(0)?), POSTFIX))
            }
            ("sign", [_]) => Some(Bound(format!("sign({})", whole(0)?), POSTFIX)),
            ("countOneBits" | "reverseBits", [argument]) => {
                let function = if name == "countOneBits" { "countbits" } else { "reversebits" };
                let text = whole(0)?;
                Some(match argument.value.ty.scalar() {
                    Some(Scalar::I32) => {
                        let ty = self.names.type_name(&value.ty, value.span)?;
                        Bound(format!("{ty}({function}(asuint({text})))"), POSTFIX)
                    }
                    _ => Bound(format!("{function}({text})"), POSTFIX),
                })
            }
            _ => None,
        })
    }

    /// `select`: HLSL computes both values of a choice.
    pub fn hlsl_select(
        &self,
        [reject, accept, condition]: [&Expression; 3],
        indent: usize,
    ) -> Result<Bound, Diagnostic> {
        let condition = self.operand(condition, 1, indent)?;
        let (accept, reject) = (self.operand(accept, 1, indent)?, self.operand(reject, 1, indent)?);
        Ok(Bound(format!("{condition} ? {accept} : {reject}"), CHOICE))
    }

    /// A product with a matrix. The rows of HLSL are the columns of WGSL.
    pub fn hlsl_product(
        &self,
        left: &Expression,
        right: &Expression,
        indent: usize,
    ) -> Result<Option<Bound>, Diagnostic> {
        let is_matrix = |value: &Expression| matches!(value.ty, Type::Matrix { .. });
        let is_scalar = |value: &Expression| matches!(value.ty, Type::Scalar(_));
        if !is_matrix(left) && !is_matrix(right) || is_scalar(left) || is_scalar(right) {
            return Ok(None);
        }
        let (left, right) = (self.whole(left.bare(), indent)?, self.whole(right.bare(), indent)?);
        Ok(Some(Bound(format!("mul({right}, {left})"), POSTFIX)))
    }
}
