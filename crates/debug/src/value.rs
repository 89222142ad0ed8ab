//! Values of a run: a scalar in f32, in f64 and with its bound, and trees of them.

use lamplight_eval::{Number, Shape, ShapePart, SlotKind, Traced, VariablePlace};
use serde_json::{Value as Json, json};

/// The most scalars of a value that are kept. A larger array is cut.
const MOST: usize = 64;

/// One scalar.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scalar {
    /// What it holds.
    pub kind: SlotKind,
    slot: Traced,
}

impl Scalar {
    /// Its 32 bits on a device that rounds to nearest.
    pub fn word(self) -> u32 {
        if self.kind == SlotKind::Float { self.slot.bits() } else { self.slot.word() }
    }

    /// The number in f64; `None` for integers and booleans, whose word is exact.
    pub fn exact(self) -> Option<f64> {
        (self.kind == SlotKind::Float).then(|| self.slot.exact())
    }

    /// The bound of the error that WGSL allows; 0 for integers and booleans.
    pub fn bound(self) -> f64 {
        if self.kind == SlotKind::Float { self.slot.bound() } else { 0.0 }
    }

    /// As f32, integer or boolean; an f32 is the shortest decimal that reads back the same.
    pub fn text(self) -> String {
        match self.kind {
            SlotKind::Float => float_text(self.slot.single()),
            SlotKind::Sint => (self.slot.word() as i32).to_string(),
            SlotKind::Bool => (self.slot.word() != 0).to_string(),
            SlotKind::Uint | SlotKind::Pointer | SlotKind::Handle => self.slot.word().to_string(),
        }
    }

    /// The value in f64 to nine digits, or an integer.
    pub fn exact_text(self) -> String {
        self.exact().map_or_else(|| self.text(), |exact| digits_text(exact, 9))
    }
}

fn float_text(value: f32) -> String {
    let plain = value == 0.0 || !value.is_finite() || (1e-4..1e7).contains(&value.abs());
    if plain { value.to_string() } else { format!("{value:e}") }
}

/// A number to some digits, without zeros at its end.
pub fn digits_text(value: f64, digits: usize) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    let scientific = format!("{value:.*e}", digits.saturating_sub(1));
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let power: i32 = exponent.parse().unwrap_or(0);
    if (-4..7).contains(&power) {
        let places = (digits as i32 - 1 - power).max(0) as usize;
        let fixed = format!("{value:.places$}");
        return without_zeros(&fixed).to_owned();
    }
    format!("{}e{power}", without_zeros(mantissa))
}

fn without_zeros(number: &str) -> &str {
    match number.contains('.') {
        true => number.trim_end_matches('0').trim_end_matches('.'),
        false => number,
    }
}

/// A value with its shape.
#[derive(Debug, Clone, PartialEq)]
pub struct Value {
    /// How it is made of scalars.
    pub shape: Shape,
    /// Its scalars in order, of a large array only the first.
    pub scalars: Vec<Scalar>,
}

impl Value {
    /// Reads a value from the memory of a run.
    pub fn read(shape: &Shape, place: VariablePlace, memory: &[Traced]) -> Self {
        Self::read_part(shape, place, 0, memory)
    }

    /// Reads a part of a value, which begins with its scalar `first`.
    pub fn read_part(shape: &Shape, place: VariablePlace, first: u32, memory: &[Traced]) -> Self {
        let scalar = |(index, kind): (usize, SlotKind)| {
            let slot = place.slot(first.saturating_add(index as u32), memory) as usize;
            Scalar { kind, slot: memory.get(slot).copied().unwrap_or_default() }
        };
        let scalars = shape.kinds(MOST).into_iter().enumerate().map(scalar).collect();
        Self { shape: shape.clone(), scalars }
    }

    /// Whether it is one scalar or a vector, which fits in a line.
    pub fn is_flat(&self) -> bool {
        matches!(self.shape, Shape::Scalar(_) | Shape::Vector(..))
    }

    /// Its type as WGSL writes it.
    pub fn type_text(&self) -> String {
        type_text(&self.shape)
    }

    /// The parts by name: members, elements, columns or components; none of a scalar.
    pub fn parts(&self) -> Vec<(String, Self)> {
        let shown = match &self.shape {
            Shape::Array(_, element) => {
                (self.scalars.len() as u32).div_ceil(element.scalars().max(1))
            }
            _ => u32::MAX,
        };
        let part = |ShapePart { name, first, shape }: ShapePart| {
            let scalars = self.scalars.iter().skip(first as usize).take(shape.scalars() as usize);
            (name, Self { scalars: scalars.copied().collect(), shape })
        };
        self.shape.parts(0..shown).map(part).collect()
    }

    /// Every scalar or vector in it, with its path.
    pub fn leaves(&self, name: &str) -> Vec<(String, Self)> {
        if self.is_flat() {
            return vec![(name.to_owned(), self.clone())];
        }
        let path = |part: &str| ShapePart::path(name, part);
        self.parts().into_iter().flat_map(|(part, value)| value.leaves(&path(&part))).collect()
    }

    /// Its scalars in f32, or as integers.
    pub fn text(&self) -> String {
        join(self.scalars.iter().map(|scalar| scalar.text()))
    }

    /// Its scalars in f64.
    pub fn exact_text(&self) -> String {
        join(self.scalars.iter().map(|scalar| scalar.exact_text()))
    }

    /// The bounds of its scalars; nothing if all are exact.
    pub fn bound_text(&self) -> String {
        if self.scalars.iter().all(|scalar| scalar.bound() == 0.0) {
            return String::new();
        }
        join(self.scalars.iter().map(|scalar| digits_text(scalar.bound(), 2)))
    }

    /// As JSON: the type, and lists of the scalars.
    pub fn json(&self) -> Json {
        let single = |scalar: &Scalar| match scalar.kind {
            SlotKind::Float => number_json(f64::from(f32::from_bits(scalar.word()))),
            SlotKind::Sint => json!(scalar.word() as i32),
            SlotKind::Bool => json!(scalar.word() != 0),
            SlotKind::Uint | SlotKind::Pointer | SlotKind::Handle => json!(scalar.word()),
        };
        let exact = |scalar: &Scalar| scalar.exact().map_or_else(|| single(scalar), number_json);
        json!({
            "type": self.type_text(),
            "f32": self.scalars.iter().map(single).collect::<Vec<_>>(),
            "f64": self.scalars.iter().map(exact).collect::<Vec<_>>(),
            "bound": self.scalars.iter().map(|one| number_json(one.bound())).collect::<Vec<_>>(),
        })
    }
}

/// A number; one that JSON has not, as a string.
pub fn number_json(value: f64) -> Json {
    if value.is_finite() { json!(value) } else { json!(value.to_string()) }
}

fn join(texts: impl Iterator<Item = String>) -> String {
    texts.collect::<Vec<_>>().join(" ")
}

fn kind_text(kind: SlotKind) -> &'static str {
    match kind {
        SlotKind::Float => "f32",
        SlotKind::Sint => "i32",
        SlotKind::Uint => "u32",
        SlotKind::Bool => "bool",
        SlotKind::Pointer => "ptr",
        SlotKind::Handle => "handle",
    }
}

pub(crate) fn type_text(shape: &Shape) -> String {
    match shape {
        Shape::Scalar(kind) => kind_text(*kind).to_owned(),
        Shape::Vector(count, kind) => format!("vec{count}<{}>", kind_text(*kind)),
        Shape::Matrix { columns, rows } => format!("mat{columns}x{rows}<f32>"),
        Shape::Array(count, element) => format!("array<{}, {count}>", type_text(element)),
        Shape::Struct(_) => "struct".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits() {
        for (value, digits, text) in [
            (0.5, 9, "0.5"),
            (1.0 / 3.0, 9, "0.333333333"),
            (123456.789, 9, "123456.789"),
            (1.5e-9, 2, "1.5e-9"),
            (1.2345e12, 3, "1.23e12"),
            (f64::NAN, 9, "NaN"),
        ] {
            assert_eq!(digits_text(value, digits), text);
        }
    }
}
