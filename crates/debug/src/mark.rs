//! Marks in words.

use lamplight_eval::FindingKind;

use crate::record::Mark;
use crate::value::digits_text;

impl Mark {
    /// A short name, for programs.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Found(kind, _) => found_name(*kind),
            Self::LostDigits(_) => "lost-digits",
            Self::OutOfRange(..) => "out-of-range",
        }
    }

    /// What a person should know.
    pub fn text(&self) -> String {
        match self {
            Self::Found(_, Some(domain)) => {
                format!("outside the domain: {domain}; WGSL leaves the result open")
            }
            Self::Found(kind, None) => found_text(*kind).to_owned(),
            Self::LostDigits(share) if share.is_infinite() => {
                "lost digits: WGSL gives no bound of the error here".to_owned()
            }
            Self::LostDigits(share) => {
                let percent = digits_text(100.0 * share, 2);
                format!("lost digits: the error may be {percent} % of the value")
            }
            Self::OutOfRange(name, words, value) => {
                let value = digits_text(*value, 6);
                format!("out of range: `{name}` is {value}, documented: {words}")
            }
        }
    }
}

fn found_name(kind: FindingKind) -> &'static str {
    match kind {
        FindingKind::NotANumber => "nan",
        FindingKind::Infinity => "infinity",
        FindingKind::DivisionByZero => "division-by-zero",
        FindingKind::Domain => "domain",
        FindingKind::Conversion => "conversion",
        FindingKind::OutOfBounds => "clamped-index",
        FindingKind::Ambiguous => "ambiguous",
        FindingKind::DivergentDerivative => "divergent-derivative",
    }
}

fn found_text(kind: FindingKind) -> &'static str {
    match kind {
        FindingKind::NotANumber => "NaN: the operands are finite, and the result is no number",
        FindingKind::Infinity => "infinity: the operands are finite, and the result is not",
        FindingKind::DivisionByZero => "division by zero",
        FindingKind::Domain => "outside the domain of the function; WGSL leaves the result open",
        FindingKind::Conversion => "conversion: the number does not fit the integer type",
        FindingKind::OutOfBounds => "clamped index: it is outside of its array or texture",
        FindingKind::Ambiguous => {
            "ambiguous: both sides are closer than their errors, so a device may decide otherwise"
        }
        FindingKind::DivergentDerivative => {
            "divergent derivative: not all four fragments of the quad are here"
        }
    }
}
