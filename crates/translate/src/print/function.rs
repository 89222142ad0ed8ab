//! Functions of WGSL as those of GLSL.

use lamplight_diagnostic::Diagnostic;

use super::dialect::Dialect;
use super::expression::{Bound, CHOICE, POSTFIX, Writer, Written, listed};
use super::range::is_at_most;
use crate::tree::{Argument, Binary, Callee, Expression, ExpressionKind, Scalar, Type};
use crate::wesl::untranslated;

/// Functions that have another name. All others that need no special form have the same.
const NAMES: [(&str, &str); 25] = [
    ("atan2", "atan"),
    ("dpdx", "dFdx"),
    ("dpdxCoarse", "dFdxCoarse"),
    ("dpdxFine", "dFdxFine"),
    ("dpdy", "dFdy"),
    ("dpdyCoarse", "dFdyCoarse"),
    ("dpdyFine", "dFdyFine"),
    ("faceForward", "faceforward"),
    ("inverseSqrt", "inversesqrt"),
    ("pack2x16float", "packHalf2x16"),
    ("pack2x16snorm", "packSnorm2x16"),
    ("pack2x16unorm", "packUnorm2x16"),
    ("pack4x8snorm", "packSnorm4x8"),
    ("pack4x8unorm", "packUnorm4x8"),
    ("reverseBits", "bitfieldReverse"),
    ("round", "roundEven"),
    ("storageBarrier", "memoryBarrierBuffer"),
    ("unpack2x16float", "unpackHalf2x16"),
    ("unpack2x16snorm", "unpackSnorm2x16"),
    ("unpack2x16unorm", "unpackUnorm2x16"),
    ("unpack4x8snorm", "unpackSnorm4x8"),
    ("unpack4x8unorm", "unpackUnorm4x8"),
    ("workgroupBarrier", "barrier"),
    ("fwidthCoarse", "fwidthCoarse"),
    ("fwidthFine", "fwidthFine"),
];

/// Functions that HLSL and MSL have by the same name. Of others, each lists those that it has.
const ALIKE: [&str; 38] = [
    "abs",
    "acos",
    "all",
    "any",
    "asin",
    "atan",
    "atan2",
    "ceil",
    "clamp",
    "cos",
    "cosh",
    "cross",
    "determinant",
    "distance",
    "dot",
    "exp",
    "exp2",
    "floor",
    "fwidth",
    "length",
    "log",
    "log2",
    "max",
    "min",
    "normalize",
    "pow",
    "reflect",
    "refract",
    "saturate",
    "sin",
    "sinh",
    "smoothstep",
    "sqrt",
    "step",
    "tan",
    "tanh",
    "transpose",
    "trunc",
];

/// Functions whose result has another type in GLSL.
const COUNTS: [(&str, &str); 3] =
    [("countOneBits", "bitCount"), ("firstLeadingBit", "findMSB"), ("firstTrailingBit", "findLSB")];

/// Functions that GLSL has only in versions that not every target has, or not at all.
const REFUSED: [&str; 5] =
    ["extractBits", "insertBits", "ldexp", "quantizeToF16", "storageBarrier"];

impl Writer<'_> {
    /// A call of a function of the language.
    pub fn builtin(
        &self,
        name: &str,
        arguments: &[Argument],
        value: &Expression,
        is_broken: bool,
        indent: usize,
    ) -> Written {
        if name.starts_with("texture") {
            return self.texture_call(name, arguments, value, indent);
        }
        let special = match self.dialect() {
            Dialect::Glsl => self.glsl_function(name, arguments, value, indent)?,
            Dialect::Hlsl => self.hlsl_function(name, arguments, value, indent)?,
            Dialect::Msl => self.msl_function(name, arguments, indent)?,
        };
        if let Some(special) = special {
            return Ok(special);
        }
        let whole = |index: usize| self.whole(&arguments[index].value, indent);
        match (name, arguments) {
            ("select", [reject, accept, condition]) => {
                self.select(&reject.value, &accept.value, &condition.value, indent)
            }
            // The languages leave the result open where the bounds are the wrong way round.
            ("clamp", [_, low, high]) if !is_at_most(&low.value, &high.value, &self.counters) => {
                Ok(called(format!("min(max({}, {}), {})", whole(0)?, whole(1)?, whole(2)?)))
            }
            // GLSL has it of signed numbers.
            ("abs", [argument]) if argument.value.ty.scalar() == Some(Scalar::U32) => {
                self.bound(&argument.value, indent)
            }
            ("all" | "any", [argument]) => self.truth(name, &argument.value, indent),
            ("dot", [left, _]) if left.value.ty.scalar() != Some(Scalar::F32) => {
                Err(untranslated(value.span, "the function `dot` of integers"))
            }
            _ if REFUSED.contains(&name) => {
                Err(untranslated(value.span, format!("the function `{name}`")))
            }
            _ => self.plain_function(name, arguments, value, is_broken, indent),
        }
    }

    /// A call that GLSL writes in a form of its own.
    fn glsl_function(
        &self,
        name: &str,
        arguments: &[Argument],
        value: &Expression,
        indent: usize,
    ) -> Result<Option<Bound>, Diagnostic> {
        Ok(Some(match (name, arguments) {
            ("saturate", [argument]) => {
                called(format!("clamp({}, 0.0, 1.0)", self.whole(&argument.value, indent)?))
            }
            ("arrayLength", [argument]) => {
                let array = self.operand(&argument.value, POSTFIX, indent)?;
                called(format!("uint({array}.length())"))
            }
            ("workgroupBarrier", []) => called("barrier()".to_owned()),
            ("countLeadingZeros" | "countTrailingZeros", [argument]) if is_scalar(argument) => {
                self.zeros(name, &argument.value, value, indent)?
            }
            ("countLeadingZeros" | "countTrailingZeros", _) => {
                let what = format!("the function `{name}` of this argument");
                return Err(untranslated(value.span, what));
            }
            _ => return Ok(None),
        }))
    }

    /// The number of zeros before or behind all ones. GLSL finds no bit in 0, where WGSL counts all.
    fn zeros(
        &self,
        name: &str,
        argument: &Expression,
        value: &Expression,
        indent: usize,
    ) -> Written {
        let is_unsigned = value.ty == Type::U32;
        let text = self.whole(argument, indent)?;
        if name == "countLeadingZeros" {
            let ty = if is_unsigned { "uint(" } else { "(" };
            return Ok(called(format!("{ty}31 - findMSB(uint({text})))")));
        }
        if !self.is_cheap(argument) {
            let what = format!("the function `{name}` of this argument");
            return Err(untranslated(value.span, what));
        }
        let compared = self.operand(argument, 8, indent)?;
        let choice = match is_unsigned {
            true => format!("{compared} == 0u ? 32u : uint(findLSB({text}))"),
            false => format!("{compared} == 0 ? 32 : findLSB({text})"),
        };
        Ok(Bound(choice, CHOICE))
    }

    fn plain_function(
        &self,
        name: &str,
        arguments: &[Argument],
        value: &Expression,
        is_broken: bool,
        indent: usize,
    ) -> Written {
        let inner = indent + usize::from(is_broken);
        let mut texts = Vec::new();
        for argument in arguments {
            texts.push((self.whole(&argument.value, inner)?, argument.is_on_new_line));
        }
        let own: Option<fn(&str) -> Option<&'static str>> = match self.dialect() {
            Dialect::Glsl => None,
            Dialect::Hlsl => Some(super::hlsl::function_name),
            Dialect::Msl => Some(super::msl::function_name),
        };
        if let Some(own) = own {
            let found = if ALIKE.contains(&name) { Some(name) } else { own(name) };
            let found =
                found.ok_or_else(|| untranslated(value.span, format!("the function `{name}`")))?;
            return Ok(called(listed(found, &texts, is_broken, indent)));
        }
        if let Some((_, glsl)) = COUNTS.iter().find(|(wgsl, _)| *wgsl == name) {
            let text = listed(glsl, &texts, is_broken, indent);
            return Ok(called(match value.ty.scalar() {
                Some(Scalar::U32) => {
                    format!("{}({text})", self.names.type_name(&value.ty, value.span)?)
                }
                _ => text,
            }));
        }
        let glsl = NAMES.iter().find(|(wgsl, _)| *wgsl == name).map_or(name, |(_, glsl)| *glsl);
        Ok(called(listed(glsl, &texts, is_broken, indent)))
    }

    /// `select` computes both values. A choice computes one, which is the same unless the other has
    /// effects or derivatives.
    fn select(
        &self,
        reject: &Expression,
        accept: &Expression,
        condition: &Expression,
        indent: usize,
    ) -> Written {
        if self.facts.has_effects(reject) || self.facts.has_effects(accept) {
            return Err(untranslated(accept.span, "a value with effects in `select`"));
        }
        match self.dialect() {
            Dialect::Glsl => {}
            Dialect::Hlsl => return self.hlsl_select([reject, accept, condition], indent),
            Dialect::Msl => return self.msl_select([reject, accept, condition], indent),
        }
        let is_vector = matches!(condition.ty, Type::Vector(..));
        let is_repeatable = self.is_repeatable(reject) && self.is_repeatable(accept);
        if !is_vector && is_repeatable {
            let condition = self.operand(condition, 1, indent)?;
            let (accept, reject) =
                (self.operand(accept, 1, indent)?, self.operand(reject, 1, indent)?);
            return Ok(Bound(format!("{condition} ? {accept} : {reject}"), CHOICE));
        }
        let texts = (self.whole(reject, indent)?, self.whole(accept, indent)?);
        let condition_text = self.whole(condition, indent)?;
        let condition = match reject.ty {
            Type::Vector(size, _) if !is_vector => format!("bvec{size}({condition_text})"),
            _ => condition_text,
        };
        match reject.ty.scalar() {
            Some(Scalar::F32) => Ok(called(format!("mix({}, {}, {condition})", texts.0, texts.1))),
            _ => Err(untranslated(accept.span, "`select` of integers by a vector")
                .note("help: choose each component by itself")),
        }
    }

    /// `all` and `any`. GLSL's `==` of vectors compares all of them, and `!=` any.
    fn truth(&self, name: &str, value: &Expression, indent: usize) -> Written {
        if !matches!(value.ty, Type::Vector(..)) {
            return self.bound(value, indent);
        }
        if let ExpressionKind::Binary { operator, left, right, .. } = &value.bare().kind
            && matches!((name, operator), ("all", Binary::Equal) | ("any", Binary::NotEqual))
            && left.ty.scalar() != Some(Scalar::Bool)
            && self.dialect() == Dialect::Glsl
        {
            let (sign, binds) = operator.spelling();
            let left = self.operand(left, binds + 1, indent)?;
            let right = self.operand(right, binds + 1, indent)?;
            return Ok(Bound(format!("{left} {sign} {right}"), binds));
        }
        Ok(called(format!("{name}({})", self.whole(value, indent)?)))
    }
}

fn called(text: String) -> Bound {
    Bound(text, POSTFIX)
}

fn is_scalar(argument: &Argument) -> bool {
    matches!(argument.value.ty, Type::Scalar(_))
}

/// Whether an expression is a call of one of some functions of the language.
pub fn calls_builtin(value: &Expression, names: &[&str]) -> bool {
    match &value.kind {
        ExpressionKind::Call { callee: Callee::Builtin(name), .. } => {
            names.contains(&name.as_str())
        }
        _ => false,
    }
}
