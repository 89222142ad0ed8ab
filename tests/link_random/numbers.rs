//! Writes scalar expressions, with the built-in functions for which writers add helpers.

use super::body::Body;
use super::types::{FLOAT, INT, Scalar, Type, UINT};

impl Body<'_> {
    pub fn float(&mut self, depth: usize) -> String {
        let glsl = self.draft.spelling.is_glsl();
        let one = self.value(&FLOAT, depth);
        match self.below(20) {
            0 if !glsl && self.has("modf") => format!("modf({one}).fract"),
            1 if !glsl && self.has("modf") => format!("modf({one}).whole"),
            2 if self.draft.is_modern && !glsl && self.has("frexp") => {
                format!("frexp({one}).fract")
            }
            3 if self.draft.is_modern && !glsl && self.has("frexp") => {
                format!("f32(frexp({one}).exp)")
            }
            4 => self.converted(depth),
            5 if self.has("dot") => self.dot(depth),
            6 if self.has("length") => {
                let one = self.value(&Type::Vector(3, Scalar::Float), depth);
                format!("length({one})")
            }
            7 if self.has("determinant") => {
                let size = 2 + self.below(2);
                let matrix = self.value(&Type::Matrix(size, size), depth);
                format!("determinant({matrix})")
            }
            8 => self.selected(one, depth),
            9 if self.has("clamp") => format!("clamp({one}, -1.0, 1.5)"),
            10 if self.has("mix") => {
                let other = self.value(&FLOAT, depth);
                format!("mix({one}, {other}, 0.25)")
            }
            11 if self.has("fract") => format!("fract({one})"),
            12 if self.has("sqrt") && self.has("abs") => format!("sqrt(abs({one}))"),
            13 if self.has("abs") => format!("({one} / (1.0 + abs({one})))"),
            14 if self.draft.is_modern && self.has("ldexp") => format!("ldexp({one}, -1)"),
            15 => self.sampled(depth).unwrap_or(one),
            16 if self.has("max") && self.has("sign") => format!("max({one}, sign({one}))"),
            17 => format!("(-{one})"),
            _ => {
                let other = self.value(&FLOAT, depth);
                let operator = self.draft.random.pick(&["+", "-", "*"]);
                format!("({one} {operator} {other})")
            }
        }
    }

    fn converted(&mut self, depth: usize) -> String {
        let ty = if self.below(2) == 0 { INT } else { UINT };
        let number = self.value(&ty, depth);
        format!("{}({number})", self.draft.spelling.scalar(Scalar::Float))
    }

    /// Converts a float to an integer. GLSL does not define what a negative float becomes as a
    /// `uint`, and naga writes the conversion as it is, so the float is made positive first. A
    /// program with matrices of two rows has no GLSL target and does not need that.
    fn whole(&mut self, scalar: Scalar, one: String, depth: usize) -> String {
        let (name, number) = (self.draft.spelling.scalar(scalar), self.value(&FLOAT, depth));
        match scalar {
            Scalar::Uint if self.draft.has_two_rows => format!("{name}({number})"),
            Scalar::Uint if self.has("abs") => format!("{name}(abs({number}))"),
            Scalar::Uint => one,
            _ => format!("{name}({number})"),
        }
    }

    fn dot(&mut self, depth: usize) -> String {
        let ty = Type::Vector(2 + self.below(3), Scalar::Float);
        let (one, other) = (self.value(&ty, depth), self.value(&ty, depth));
        format!("dot({one}, {other})")
    }

    /// One of two numbers, by a condition.
    fn selected(&mut self, one: String, depth: usize) -> String {
        let (other, condition) = (self.value(&FLOAT, depth), self.condition(depth));
        match self.draft.spelling.is_glsl() {
            true => format!("({condition} ? {one} : {other})"),
            false if self.has("select") => format!("select({one}, {other}, {condition})"),
            false => one,
        }
    }

    pub fn integer(&mut self, scalar: Scalar, depth: usize) -> String {
        let ty = Type::Scalar(scalar);
        let name = self.draft.spelling.scalar(scalar);
        let (most, some) = if scalar == Scalar::Int { ("31", "1") } else { ("31u", "1u") };
        let one = self.value(&ty, depth);
        match self.below(18) {
            0 | 1 => {
                let other = self.value(&ty, depth);
                format!("({one} / ({other} | {some}))")
            }
            2 | 3 => {
                let other = self.value(&ty, depth);
                format!("({one} % ({other} | {some}))")
            }
            4 | 5 => self.whole(scalar, one, depth),
            6 if scalar == Scalar::Int => format!("(-{one})"),
            7 if scalar == Scalar::Int && self.has("abs") => format!("abs({one})"),
            8 if self.has("clamp") => {
                let low = if scalar == Scalar::Int { "-3" } else { "1u" };
                format!("clamp({one}, {low}, {most})")
            }
            9 => {
                let other = if scalar == Scalar::Int { UINT } else { INT };
                let other = self.value(&other, depth);
                format!("{name}({other})")
            }
            10 => self.bits(scalar, &one, depth),
            11 if self.has("max") => {
                let other = self.value(&ty, depth);
                format!("max({one}, {other})")
            }
            12 => format!("({one} << 1u)"),
            13 => format!("({one} >> 1u)"),
            14 if !self.draft.spelling.is_glsl() && self.has("dot") => {
                let ty = Type::Vector(2 + self.below(3), scalar);
                let (one, other) = (self.value(&ty, depth), self.value(&ty, depth));
                format!("(dot({one}, {other}) & {most})")
            }
            _ => {
                let other = self.value(&ty, depth);
                let operator = self.draft.random.pick(&["+", "-", "*", "&", "|", "^"]);
                format!("(({one} {operator} {other}) & {most})")
            }
        }
    }

    /// A built-in function on the bits of an integer.
    fn bits(&mut self, scalar: Scalar, one: &str, depth: usize) -> String {
        if self.draft.spelling.is_glsl() || !self.draft.is_modern {
            return one.to_owned();
        }
        match self.below(6) {
            0 if self.has("extractBits") => format!("extractBits({one}, 1u, 3u)"),
            1 if self.has("insertBits") => {
                let other = self.value(&Type::Scalar(scalar), depth);
                format!("insertBits({one}, {other}, 2u, 3u)")
            }
            2 if self.has("countOneBits") => format!("countOneBits({one})"),
            3 if self.has("firstLeadingBit") => {
                format!("firstLeadingBit({one} | 1{})", end(scalar))
            }
            4 if self.has("firstTrailingBit") => {
                format!("firstTrailingBit({one} | 8{})", end(scalar))
            }
            _ if self.has("countLeadingZeros") => format!("countLeadingZeros({one})"),
            _ => one.to_owned(),
        }
    }
}

fn end(scalar: Scalar) -> &'static str {
    if scalar == Scalar::Uint { "u" } else { "" }
}
