//! Error models: how far a result may be off, as a sum of terms.
//!
//! With u = 2^-23, y the expected component:
//!
//! | term | allows |
//! |---|---|
//! | `ulp = k` | k units in the last place of y |
//! | `abs = a` | a |
//! | `rel = r` | r*\|y\| |
//! | `pow = { base, exponent, ulp }` | what WGSL allows `pow(x, s)`: \|y\|*(s*ln2*2^-21 + \|t\|*ln2*u + (3 + 2\|t\|)*u + s*ulp*u/2), t = s*log2(x); `ulp` is the error of the base, 2 by default |
//! | `scaled = { by, ulp }` | ulp*u*\|by\|: for sums, `by` is the sum of the terms' magnitudes |
//!
//! A table may name one part of a struct's result with `for`. Terms without `for` apply to all
//! parts.

use super::formula::{Formula, Scope};
use lamplight_diagnostic::Diagnostic;
use lamplight_execute::kernel::TypeShape;

const U: f64 = 1.0 / 8_388_608.0;

pub struct TermKind {
    pub name: &'static str,
    /// Keys whose values are formulas.
    pub formulas: &'static [&'static str],
    /// Coefficient where none is given.
    pub default: f64,
    /// Allowed error from coefficient, formulas' values and expected component.
    allowed: fn(f64, &[f64], f64) -> f64,
}

/// Every kind, by name.
pub const TERMS: &[TermKind] = &[
    TermKind { name: "ulp", formulas: &[], default: 1.0, allowed: |k, _, y| k * ulp_of(y) },
    TermKind { name: "abs", formulas: &[], default: 0.0, allowed: |a, _, _| a },
    TermKind { name: "rel", formulas: &[], default: 0.0, allowed: |r, _, y| r * y.abs() },
    TermKind { name: "pow", formulas: &["base", "exponent"], default: 2.0, allowed: pow_error },
    TermKind {
        name: "scaled",
        formulas: &["by"],
        default: 1.0,
        allowed: |k, of, _| k * U * of[0].abs(),
    },
];

/// One term of a case. `F` is a text first, and a formula once it is bound.
#[derive(Debug, Clone)]
pub struct Term<F> {
    pub kind: &'static TermKind,
    pub coefficient: f64,
    pub formulas: Vec<F>,
    /// The path of the part of the result that it applies to.
    pub only: Option<String>,
}

impl std::fmt::Debug for TermKind {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name)
    }
}

pub fn find_kind(name: &str) -> Option<&'static TermKind> {
    TERMS.iter().find(|kind| kind.name == name)
}

/// A term over a function's parameters, with the result words that it applies to.
#[derive(Debug)]
pub struct BoundTerm {
    term: Term<Formula>,
    words: std::ops::Range<usize>,
}

impl BoundTerm {
    /// Steps that it takes for a row.
    pub fn parts(&self) -> usize {
        1 + self.term.formulas.iter().map(Formula::parts).sum::<usize>()
    }
}

/// Binds the formulas of a case's terms.
pub fn bind_terms(
    terms: &[Term<super::cases::FormulaText>],
    scope: &Scope<'_>,
    result: &[TypeShape],
) -> Result<Vec<BoundTerm>, Diagnostic> {
    let all: u32 = result.iter().map(TypeShape::words).sum();
    let bound = terms.iter().map(|term| {
        let words = match &term.only {
            Some(path) => result_part(path, result).ok_or_else(|| {
                let message = format!("the result has no part `{path}`");
                Diagnostic::error(lamplight_diagnostic::codes::CASE_INVALID, message)
            })?,
            None => 0..all as usize,
        };
        let formulas =
            term.formulas.iter().map(|text| text.bind(scope)).collect::<Result<_, _>>()?;
        Ok(BoundTerm {
            term: Term {
                kind: term.kind,
                coefficient: term.coefficient,
                formulas,
                only: term.only.clone(),
            },
            words,
        })
    });
    bound.collect()
}

fn result_part(path: &str, result: &[TypeShape]) -> Option<std::ops::Range<usize>> {
    let parts: Vec<String> = path.split('.').map(str::to_owned).collect();
    let (first, shape) = result.first()?.part(&parts)?;
    Some(first as usize..(first + shape.words()) as usize)
}

/// The value of each formula in the terms of a tolerance, for one row of inputs. All components of
/// the result share these values, so they are computed once.
pub fn formula_values(terms: &[BoundTerm], row: &[f64]) -> Vec<f64> {
    terms.iter().flat_map(|bound| &bound.term.formulas).map(|formula| formula.scalar(row)).collect()
}

/// How many values [`formula_values`] gives.
pub fn formula_count(terms: &[BoundTerm]) -> usize {
    terms.iter().map(|bound| bound.term.formulas.len()).sum()
}

/// What the terms allow for one component of a row's result, given the row's [`formula_values`].
pub fn allowed_error(terms: &[BoundTerm], values: &[f64], word: usize, expected: f64) -> f64 {
    let (mut sum, mut rest) = (0.0, values);
    for BoundTerm { term, words } in terms {
        let (own, others) = rest.split_at(term.formulas.len().min(rest.len()));
        rest = others;
        let allowed = (term.kind.allowed)(term.coefficient, own, expected);
        if words.contains(&word) && !allowed.is_nan() {
            sum += allowed;
        }
    }
    sum
}

/// Distance from the f32 nearest to `y` to its neighbour away from zero.
pub fn ulp_of(y: f64) -> f64 {
    let y = (y as f32).abs().clamp(f32::MIN_POSITIVE, f32::MAX.next_down());
    f64::from(y.next_up()) - f64::from(y)
}

/// `exp2(s*log2(x))` as the WGSL specification bounds it, with the base's own error.
fn pow_error(ulps: f64, of: &[f64], y: f64) -> f64 {
    let (x, s) = (of[0], of[1].abs());
    if x <= 0.0 {
        return 0.0;
    }
    let t = (s * x.log2()).abs();
    let ln2 = std::f64::consts::LN_2;
    y.abs() * (s * ln2 * 4.0 * U + t * ln2 * U + (3.0 + 2.0 * t) * U + s * ulps * U / 2.0)
}
