//! Marks: what a reader should look at, where it happens first, and its words.

use std::collections::BTreeSet;

use lamplight_eval::{Executed, FindingKind, FunctionId, Traced};

use crate::subject::Subject;
use crate::value::{Value, digits_text};

/// Something that a reader should look at, where it happens first.
#[derive(Debug, Clone, PartialEq)]
pub enum Mark {
    /// What the evaluator noticed, and for an argument outside of a function's domain, which.
    Found(FindingKind, Option<&'static str>),
    /// The bound of a value is above the stated share, and those of its operands are not. The
    /// share is infinite where WGSL gives no bound.
    LostDigits(f64),
    /// An argument that documentation excludes: the parameter, its documentation, and the value.
    OutOfRange(String, String, f64),
}

/// Notices what is to be marked. Everything is marked once.
#[derive(Debug, Clone)]
pub struct Notice {
    /// The share of a value that its bound may have before its digits count as lost.
    share: f64,
    /// Parameters of which was said that their value is out of range.
    excluded: BTreeSet<usize>,
    /// Instructions that lost digits.
    lost: BTreeSet<u32>,
}

impl Notice {
    /// Nothing is marked yet.
    pub fn new(share: f64) -> Self {
        Self { share, excluded: BTreeSet::new(), lost: BTreeSet::new() }
    }

    /// What is to be said of an argument of a call: the function, and the number of its parameter
    /// among the program's variables.
    pub fn argument(
        &mut self,
        subject: &Subject,
        (function, index): (FunctionId, usize),
        value: &Value,
    ) -> Option<Mark> {
        let name = &subject.program.variables().get(index)?.name;
        let documented = subject.documented(function, name)?;
        let mut exact = value.scalars.iter().filter_map(|scalar| scalar.exact());
        let wrong = exact.find(|value| !documented.has(*value))?;
        let is_new = self.excluded.insert(index);
        is_new.then(|| Mark::OutOfRange(name.clone(), documented.words.clone(), wrong))
    }

    /// What is to be said of an instruction that ran.
    pub fn instruction(&mut self, seen: &Executed<'_, Traced>) -> Vec<Mark> {
        let found = seen
            .found
            .iter()
            .map(|kind| Mark::Found(*kind, seen.domain().filter(|_| *kind == FindingKind::Domain)));
        found.chain(self.lost_digits(seen)).collect()
    }

    /// Marks an instruction whose result has lost digits that its operands have.
    fn lost_digits(&mut self, seen: &Executed<'_, Traced>) -> Option<Mark> {
        let share = self.share;
        let is_lost = |slot: u32, memory: &[Traced]| {
            memory.get(slot as usize).map(|slot| lost_share(*slot)).filter(|lost| *lost > share)
        };
        let worst =
            seen.written().filter_map(|slot| is_lost(slot, seen.memory)).reduce(f64::max)?;
        let mut is_inherited = false;
        seen.read(&mut |mut range| {
            is_inherited |= range.any(|slot| is_lost(slot, seen.memory).is_some());
        });
        (!is_inherited && self.lost.insert(seen.pc)).then_some(Mark::LostDigits(worst))
    }
}

/// The share of a value that its bound has. A bound that is small by itself counts as none.
fn lost_share(slot: Traced) -> f64 {
    const SMALL: f64 = 1e-6;
    let (value, bound) = (slot.exact().abs(), slot.bound());
    if bound <= SMALL || !value.is_finite() { 0.0 } else { bound / value }
}

impl Mark {
    /// The names of all kinds of marks, each with a title.
    pub const KINDS: [(&str, &str); 10] = [
        ("nan", "NaN"),
        ("infinity", "Infinity"),
        ("division-by-zero", "Division by zero"),
        ("domain", "Argument outside of the domain"),
        ("conversion", "Number that does not fit its integer type"),
        ("clamped-index", "Clamped index"),
        ("ambiguous", "Ambiguous comparison"),
        ("divergent-derivative", "Divergent derivative"),
        ("lost-digits", "Lost digits"),
        ("out-of-range", "Argument that documentation excludes"),
    ];

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
