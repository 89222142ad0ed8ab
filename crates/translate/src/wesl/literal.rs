//! Numbers as WGSL writes them.

use lamplight_diagnostic::source::Span;
use lamplight_diagnostic::{Diagnostic, codes};

use super::untranslated;
use crate::tree::{Number, NumberValue, Scalar};

/// A number, and its type by its suffix.
pub fn read_number(text: &str, span: Span) -> Result<(Number, Scalar), Diagnostic> {
    let wrong = || {
        Diagnostic::error(codes::SYNTAX_ERROR, format!("`{text}` is not a number"))
            .at(span, "not a number")
    };
    let is_hex = text.starts_with("0x") || text.starts_with("0X");
    let is_hex_float = is_hex && text.contains(['.', 'p', 'P']);
    let (digits, suffix) = match text.as_bytes().last() {
        Some(b'i' | b'u') => text.split_at(text.len() - 1),
        Some(b'f' | b'h') if !is_hex || is_hex_float => text.split_at(text.len() - 1),
        _ => (text, ""),
    };
    if suffix == "h" {
        return Err(untranslated(span, "16-bit floats"));
    }
    let is_float = is_hex_float || suffix == "f" || !is_hex && digits.contains(['.', 'e', 'E']);
    let value = match (is_float, is_hex) {
        (true, true) => NumberValue::Float(hex_float(digits).ok_or_else(wrong)?),
        (true, false) => NumberValue::Float(digits.parse().map_err(|_| wrong())?),
        (false, true) => {
            NumberValue::Integer(i64::from_str_radix(&digits[2..], 16).map_err(|_| wrong())?)
        }
        (false, false) => NumberValue::Integer(digits.parse().map_err(|_| wrong())?),
    };
    let scalar = match (suffix, is_float) {
        ("i", _) => Scalar::I32,
        ("u", _) => Scalar::U32,
        ("f", _) => Scalar::F32,
        (_, true) => Scalar::AbstractFloat,
        (_, false) => Scalar::AbstractInteger,
    };
    Ok((Number { text: digits.to_owned(), value }, scalar))
}

/// `0x1.8p-3`.
fn hex_float(text: &str) -> Option<f64> {
    let (digits, exponent) = match text[2..].split_once(['p', 'P']) {
        Some((digits, exponent)) => (digits, exponent.parse::<i32>().ok()?),
        None => (&text[2..], 0),
    };
    let (whole, part) = digits.split_once('.').unwrap_or((digits, ""));
    let mut value = 0.0_f64;
    for digit in whole.chars().chain(part.chars()) {
        value = value * 16.0 + f64::from(digit.to_digit(16)?);
    }
    let scale = exponent.checked_sub(4 * i32::try_from(part.len()).ok()?)?;
    Some(value * 2.0_f64.powi(scale))
}

#[cfg(test)]
mod tests {
    use super::*;
    use lamplight_diagnostic::source::SourceSet;

    fn value(text: &str) -> Option<(NumberValue, Scalar)> {
        let mut sources = SourceSet::default();
        let id = sources.add("a.wesl", text);
        let found = read_number(text, Span::new(id, 0..text.len())).ok()?;
        Some((found.0.value, found.1))
    }

    #[test]
    fn suffixes_decide() {
        assert_eq!(value("7u"), Some((NumberValue::Integer(7), Scalar::U32)));
        assert_eq!(value("0x1fu"), Some((NumberValue::Integer(31), Scalar::U32)));
        assert_eq!(value("0x1f"), Some((NumberValue::Integer(31), Scalar::AbstractInteger)));
        assert_eq!(value("1f"), Some((NumberValue::Float(1.0), Scalar::F32)));
        assert_eq!(value(".5"), Some((NumberValue::Float(0.5), Scalar::AbstractFloat)));
        assert_eq!(value("0x1.8p1"), Some((NumberValue::Float(3.0), Scalar::AbstractFloat)));
        assert_eq!(value("0x1p-2f"), Some((NumberValue::Float(0.25), Scalar::F32)));
        assert_eq!(value("1h"), None);
    }
}
