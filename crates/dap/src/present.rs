//! How values look.

use lamplight_debug::{Scalar, Value as Traced, digits_text};
use serde_json::{Value, json};

/// A value on one line, as a device computes it that rounds to nearest. Of values that are made of
/// parts, all scalars.
pub(crate) fn flat_text(value: &Traced) -> String {
    let all: Vec<String> = value.scalars.iter().map(|scalar| scalar.text()).collect();
    match all.as_slice() {
        [one] => one.clone(),
        _ => format!("({})", all.join(", ")),
    }
}

/// A value as a row shows it, with the bound of its error where it has one.
pub(crate) fn shown(value: &Traced, type_name: &str) -> String {
    if !value.is_flat() {
        return type_name.to_owned();
    }
    let bound = value.scalars.iter().map(|scalar| scalar.bound()).fold(0.0, f64::max);
    let text = flat_text(value);
    match (value.scalars.as_slice(), bound) {
        (_, 0.0) => text,
        ([one], _) => format!("{text} (f64 {} +- {})", one.exact_text(), digits_text(bound, 2)),
        _ => format!("{text} +- {}", digits_text(bound, 2)),
    }
}

/// The parts of a number: what it is in f32 and f64, and its bound.
pub(crate) fn number_rows(scalar: &Scalar) -> Vec<Value> {
    let row = |name: &str, value: String, ty: &str| json!({ "name": name, "value": value, "type": ty, "variablesReference": 0 });
    let Some(exact) = scalar.exact() else { return Vec::new() };
    vec![
        row("f32", scalar.text(), "f32"),
        row("f64", exact.to_string(), "f64"),
        row("bound", digits_text(scalar.bound(), 3), "f64"),
    ]
}
