//! Laws: what holds between a function's values, whatever the oracle says.
//!
//! | law | holds |
//! |---|---|
//! | `range = [low, high]` | every component lies there, bounds included, exactly |
//! | `rising = "x"`, `falling = "x"` | a larger `x` never gives a smaller (larger) value, up to the tolerance |
//! | `swap = ["l", "v"]` | exchanging the parameters changes nothing: symmetry, reciprocity |
//! | `even = ["n", "l"]` | negating the parameters changes nothing |
//! | `at = { d = 0 }, gives = 1` | the value there, whatever the other parameters are |
//! | `reaches = [low, high]` | some row comes at least that low and some that high: the inputs are no trivial ones |

use super::cases::Rows;
use super::formula::Scope;
use super::kernel::Shape;
use crate::diagnostic::Diagnostic;
use crate::source::Span;
use naga::ScalarKind;

/// A kind of law.
pub struct Kind {
    pub name: &'static str,
    pub takes: Takes,
}

/// What the law's key is given.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Takes {
    Numbers,
    Names,
    /// Values of parameters; the expected result is in `gives`.
    Point,
}

/// Every kind.
pub const KINDS: &[Kind] = &[
    Kind { name: "range", takes: Takes::Numbers },
    Kind { name: "reaches", takes: Takes::Numbers },
    Kind { name: "rising", takes: Takes::Names },
    Kind { name: "falling", takes: Takes::Names },
    Kind { name: "swap", takes: Takes::Names },
    Kind { name: "even", takes: Takes::Names },
    Kind { name: "at", takes: Takes::Point },
];

/// One law of a case.
#[derive(Debug)]
pub struct Law {
    pub kind: &'static Kind,
    pub span: Span,
    pub names: Vec<String>,
    pub numbers: Vec<f64>,
    pub at: Vec<(String, Vec<f64>)>,
}

impl std::fmt::Debug for Kind {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name)
    }
}

/// The kind of that name.
pub fn find(name: &str) -> Option<&'static Kind> {
    KINDS.iter().find(|kind| kind.name == name)
}

/// The rows that the law compares a case's rows with; `None` for laws of single values.
pub fn transformed(law: &Law, rows: &Rows, scope: &Scope<'_>) -> Result<Option<Rows>, Diagnostic> {
    let mut words = rows.words.clone();
    let places: Vec<_> = law.names.iter().map(|name| place(law, name, scope)).collect::<Result<_, _>>()?;
    for row in words.chunks_mut(rows.stride) {
        match law.kind.name {
            "rising" | "falling" => places
                .iter()
                .flat_map(|(first, shape)| *first..first + shape.words() as usize)
                .for_each(|word| raise(&mut row[word], rows.kinds[word])),
            "even" => {
                places.iter().flat_map(|(first, shape)| *first..first + shape.words() as usize).for_each(|word| row[word] ^= 0x8000_0000)
            }
            "swap" => swap(row, &places),
            "at" => set(law, row, scope)?,
            _ => return Ok(None),
        }
    }
    Ok(Some(rows.with_words(words)))
}

fn place<'a>(law: &Law, name: &str, scope: &'a Scope<'_>) -> Result<(usize, &'a Shape), Diagnostic> {
    let parts: Vec<String> = name.split('.').map(str::to_owned).collect();
    scope.find(&parts).ok_or_else(|| scope.unknown(name).at(law.span, "in this law"))
}

/// A value one part in sixteen larger, at least by the smallest normal number.
fn raise(word: &mut u32, kind: ScalarKind) {
    *word = match kind {
        ScalarKind::Float => {
            let value = f32::from_bits(*word);
            (value + value.abs() / 16.0 + f32::MIN_POSITIVE).to_bits()
        }
        _ => word.saturating_add(1),
    };
}

fn swap(row: &mut [u32], places: &[(usize, &Shape)]) {
    if let [(first, shape), (second, other)] = places {
        for word in 0..shape.words().min(other.words()) as usize {
            row.swap(first + word, second + word);
        }
    }
}

fn set(law: &Law, row: &mut [u32], scope: &Scope<'_>) -> Result<(), Diagnostic> {
    for (name, values) in &law.at {
        let (first, shape) = place(law, name, scope)?;
        for (index, kind) in shape.kinds().into_iter().enumerate() {
            let value = values.get(if values.len() == 1 { 0 } else { index }).copied().unwrap_or(0.0);
            row[first + index] = super::cases::word(value, kind);
        }
    }
    Ok(())
}

/// How far a value breaks a law, beyond nothing: `value` of the row itself, `other` of the
/// transformed row, `word` the component.
pub fn broken_by(law: &Law, value: f64, other: Option<f64>, word: usize) -> f64 {
    let number = |index: usize| law.numbers.get(if law.numbers.len() == 1 { 0 } else { index }).copied().unwrap_or(f64::NAN);
    match (law.kind.name, other) {
        ("range", _) => (number(0) - value).max(value - number(1)).max(0.0),
        ("rising", Some(other)) => (value - other).max(0.0),
        ("falling", Some(other)) => (other - value).max(0.0),
        ("swap" | "even", Some(other)) => (other - value).abs(),
        ("at", Some(other)) => (other - number(word)).abs(),
        _ => 0.0,
    }
}
