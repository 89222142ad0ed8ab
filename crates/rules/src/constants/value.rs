//! The values of constant expressions, with their types.

use half::f16;

/// The type of a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// A whole number that fits any type of numbers.
    AbstractInt,
    /// A number that fits any type of floating-point numbers.
    AbstractFloat,
    I32,
    U32,
    F32,
    F16,
    Bool,
}

/// How the numbers of a value are arranged.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    Scalar,
    Vector(usize),
    /// Columns, and their length.
    Matrix(usize, usize),
}

/// The value of a constant expression. Numbers of a matrix are in the order of its columns.
#[derive(Debug, Clone, PartialEq)]
pub struct Value {
    pub kind: Kind,
    pub shape: Shape,
    pub parts: Vec<f64>,
}

/// Whole numbers beyond this are not exact.
const LARGEST_INT: f64 = 9_007_199_254_740_992.0;

impl Kind {
    pub fn named(name: &str) -> Option<Self> {
        Some(match name {
            "i32" => Self::I32,
            "u32" => Self::U32,
            "f32" => Self::F32,
            "f16" => Self::F16,
            "bool" => Self::Bool,
            _ => return None,
        })
    }

    /// The kind that a suffix of a type or of a number stands for.
    pub fn of_suffix(suffix: &str) -> Option<Self> {
        Some(match suffix {
            "i" => Self::I32,
            "u" => Self::U32,
            "f" => Self::F32,
            "h" => Self::F16,
            _ => return None,
        })
    }

    pub fn is_float(self) -> bool {
        matches!(self, Self::AbstractFloat | Self::F32 | Self::F16)
    }

    pub fn is_int(self) -> bool {
        matches!(self, Self::AbstractInt | Self::I32 | Self::U32)
    }

    /// The number of this kind that a result becomes; `None` where it has none.
    pub fn round(self, number: f64) -> Option<f64> {
        let rounded = match self {
            Self::AbstractInt => number.trunc(),
            Self::AbstractFloat => number,
            Self::I32 | Self::U32 => number.trunc(),
            Self::F32 => f64::from(number as f32),
            Self::F16 => f16::from_f64(number).to_f64(),
            Self::Bool => f64::from(u8::from(number != 0.0)),
        };
        let fits = match self {
            Self::AbstractInt => rounded.abs() <= LARGEST_INT,
            Self::I32 => (f64::from(i32::MIN)..=f64::from(i32::MAX)).contains(&rounded),
            Self::U32 => (0.0..=f64::from(u32::MAX)).contains(&rounded),
            Self::AbstractFloat | Self::F32 | Self::F16 | Self::Bool => rounded.is_finite(),
        };
        fits.then_some(rounded)
    }

    /// The kind to which both convert without being asked to.
    pub fn common(self, other: Self) -> Option<Self> {
        match (self, other) {
            (one, other) if one == other => Some(one),
            (Self::AbstractInt, other) if other != Self::Bool => Some(other),
            (one, Self::AbstractInt) if one != Self::Bool => Some(one),
            (Self::AbstractFloat, other) if other.is_float() => Some(other),
            (one, Self::AbstractFloat) if one.is_float() => Some(one),
            _ => None,
        }
    }
}

impl Shape {
    pub fn count(self) -> usize {
        match self {
            Self::Scalar => 1,
            Self::Vector(count) => count,
            Self::Matrix(columns, rows) => columns * rows,
        }
    }
}

impl Value {
    /// A value of numbers that are rounded to their kind.
    pub fn new(kind: Kind, shape: Shape, parts: &[f64]) -> Option<Self> {
        let parts: Option<Vec<f64>> = parts.iter().map(|part| kind.round(*part)).collect();
        parts.filter(|parts| parts.len() == shape.count()).map(|parts| Self { kind, shape, parts })
    }

    pub fn scalar(kind: Kind, number: f64) -> Option<Self> {
        Self::new(kind, Shape::Scalar, &[number])
    }

    /// A number as it is written, `true` or `false`.
    pub fn literal(text: &str) -> Option<Self> {
        if let "true" | "false" = text {
            return Self::scalar(Kind::Bool, f64::from(u8::from(text == "true")));
        }
        if let Some(digits) = text.strip_prefix("0x").or_else(|| text.strip_prefix("0X")) {
            let number = digits.trim_end_matches(['i', 'u']);
            let kind = Kind::of_suffix(&digits[number.len()..]).unwrap_or(Kind::AbstractInt);
            return Self::scalar(kind, u64::from_str_radix(number, 16).ok()? as f64);
        }
        let number = text.trim_end_matches(['i', 'u', 'f', 'h']);
        let kind = match Kind::of_suffix(&text[number.len()..]) {
            Some(kind) => kind,
            None if number.contains(['.', 'e', 'E']) => Kind::AbstractFloat,
            None => Kind::AbstractInt,
        };
        Self::scalar(kind, number.parse().ok()?)
    }

    /// The only number.
    pub fn number(&self) -> Option<f64> {
        (self.shape == Shape::Scalar).then(|| self.parts.first().copied()).flatten()
    }

    /// The same value as another kind, without being asked to.
    pub fn converted(&self, kind: Kind) -> Option<Self> {
        (self.kind.common(kind) == Some(kind)).then(|| self.cast(kind)).flatten()
    }

    /// The same value as another kind, as a conversion gives it.
    pub fn cast(&self, kind: Kind) -> Option<Self> {
        // Integers of 32 bits keep their bits.
        let wrapped = |part: f64| match (self.kind, kind) {
            (Kind::I32, Kind::U32) => f64::from(part as i32 as u32),
            (Kind::U32, Kind::I32) => f64::from(part as u32 as i32),
            _ => part,
        };
        let clamped = |part: f64| match kind {
            Kind::I32 if self.kind.is_float() => {
                part.clamp(f64::from(i32::MIN), f64::from(i32::MAX))
            }
            Kind::U32 if self.kind.is_float() => part.clamp(0.0, f64::from(u32::MAX)),
            _ => wrapped(part),
        };
        let parts: Vec<f64> = self.parts.iter().map(|part| clamped(*part)).collect();
        Self::new(kind, self.shape, &parts)
    }

    /// The value as an expression in WGSL.
    pub fn text(&self) -> String {
        let parts: Vec<String> = self.parts.iter().map(|part| self.part_text(*part)).collect();
        let parts = parts.join(", ");
        match self.shape {
            Shape::Scalar => parts,
            Shape::Vector(count) => format!("vec{count}({parts})"),
            Shape::Matrix(columns, rows) => format!("mat{columns}x{rows}({parts})"),
        }
    }

    fn part_text(&self, part: f64) -> String {
        match self.kind {
            Kind::AbstractInt => format!("{part}"),
            Kind::AbstractFloat => format!("{part:?}"),
            // The lowest number has no spelling with a suffix.
            Kind::I32 => format!("i32({part})"),
            Kind::U32 => format!("{part}u"),
            Kind::F32 => format!("{:?}f", part as f32),
            Kind::F16 => format!("{:?}h", part as f32),
            Kind::Bool => (part != 0.0).to_string(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Kind, Value};

    #[test]
    fn literals_have_the_kind_that_their_spelling_says() {
        let cases = [
            ("1", Kind::AbstractInt, 1.0),
            ("0x1f", Kind::AbstractInt, 31.0),
            ("0xffu", Kind::U32, 255.0),
            ("1.", Kind::AbstractFloat, 1.0),
            ("1e2", Kind::AbstractFloat, 100.0),
            ("1f", Kind::F32, 1.0),
            (".5h", Kind::F16, 0.5),
            ("true", Kind::Bool, 1.0),
        ];
        for (text, kind, number) in cases {
            let value = Value::literal(text).unwrap();
            assert_eq!((value.kind, value.number()), (kind, Some(number)), "{text}");
        }
        for text in ["65536h", "2147483648i", "4294967296u", "1e39f"] {
            assert_eq!(Value::literal(text), None, "{text}");
        }
    }

    #[test]
    fn conversions_keep_the_bits_of_integers_and_clamp_floats() {
        let cast = |text: &str, kind| Value::literal(text).unwrap().cast(kind).unwrap().parts[0];
        assert_eq!(cast("4294967295u", Kind::I32), -1.0);
        assert_eq!(cast("3e9f", Kind::I32), 2_147_483_647.0);
        assert_eq!(cast("2.9f", Kind::U32), 2.0);
        assert_eq!(Value::literal("1f").unwrap().converted(Kind::I32), None);
    }
}
