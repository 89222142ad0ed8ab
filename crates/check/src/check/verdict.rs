//! Compares what an executor returned with what was expected.

use super::facts;
use super::job::{CaseJob, Goal};
use super::law::LawVerdict;
use super::profile::Profile;
use crate::cases::Rows;
use crate::tolerance;
use lamplight_execute::kernel::word_value;
use naga::ScalarKind;

/// The result of checking the rows of a case.
#[derive(Debug, Default)]
pub struct CaseVerdict {
    /// How many rows were tried.
    pub inputs: usize,
    /// Rows for which every result is accepted: f32 cannot represent the expected value, or the
    /// function promises nothing there.
    pub indeterminate: usize,
    /// Rows that are wrong, but where rounding may decide a comparison.
    pub ambiguous: usize,
    /// Whether there are more ambiguous rows than the case allows.
    pub too_ambiguous: bool,
    /// The component whose error is the largest share of its tolerance.
    pub worst: Option<Worst>,
    /// The largest error of the rows that are not counted as ambiguous.
    pub largest: f64,
    /// Rows that are wrong.
    pub failing: Vec<usize>,
    pub laws: Vec<LawVerdict>,
    /// Largest distance from the results of the first language, in units in the last place.
    pub parity: Option<f64>,
    /// A small failing input, as text, with a case to paste.
    pub smallest: Option<String>,
    /// How the error depends on the inputs, if that was asked for.
    pub profile: Option<Box<Profile>>,
}

/// The error of one component of one row.
#[derive(Debug, Clone, Copy)]
pub struct Worst {
    pub row: usize,
    pub word: usize,
    pub found: f64,
    pub expected: f64,
    pub error: f64,
    pub allowed: f64,
}

impl CaseVerdict {
    /// Whether every row and every law holds.
    pub fn passed(&self) -> bool {
        self.failing.is_empty() && self.passed_but_for_values()
    }

    /// Whether everything holds besides the tolerances of the values.
    pub fn passed_but_for_values(&self) -> bool {
        !self.too_ambiguous && !self.proves_nothing() && self.laws.iter().all(|law| law.broken == 0)
    }

    /// Whether every possible value would have been accepted. Then nothing was tested.
    pub fn proves_nothing(&self) -> bool {
        self.inputs > 0 && self.indeterminate == self.inputs
    }
}

impl Worst {
    /// The error divided by what is allowed. The component passes up to 1.
    pub fn share(&self) -> f64 {
        if self.error == 0.0 { 0.0 } else { self.error / self.allowed }
    }

    /// The error in units in the last place of the expected value.
    pub fn ulps(&self) -> f64 {
        self.error / tolerance::ulp_of(self.expected)
    }

    /// What is allowed, in units in the last place of the expected value.
    pub fn allowed_ulps(&self) -> f64 {
        self.allowed / tolerance::ulp_of(self.expected)
    }
}

/// Compares every row.
pub fn check_rows(
    job: &CaseJob<'_>,
    rows: &Rows,
    expected: &[Goal],
    results: &[u32],
) -> CaseVerdict {
    let kinds = job.kernel().result_kinds();
    let mut verdict = CaseVerdict { inputs: rows.len(), ..CaseVerdict::default() };
    for (index, (goal, found)) in
        expected.iter().zip(results.chunks(kinds.len().max(1))).enumerate()
    {
        if is_indeterminate(goal) {
            verdict.indeterminate += 1;
            continue;
        }
        let Some(worst) = compare_goal(job, rows, goal, found, &kinds, index) else { continue };
        let is_ambiguous = goal.doubtful || facts::is_ambiguous(job, rows, index);
        if worst.share() <= 1.0 || !is_ambiguous {
            verdict.largest = verdict.largest.max(worst.error);
        }
        if worst.share() <= 1.0 {
            if verdict.worst.is_none_or(|known| known.share() <= worst.share()) {
                verdict.worst = Some(worst);
            }
        } else if is_ambiguous {
            verdict.ambiguous += 1;
        } else {
            verdict.failing.push(index);
            if verdict.worst.is_none_or(|known| known.share() < worst.share()) {
                verdict.worst = Some(worst);
            }
        }
    }
    verdict.too_ambiguous = verdict.ambiguous as f64 > job.case.ambiguous * rows.len() as f64;
    verdict
}

/// Compares with each accepted value, and returns the worst component for the value that fits best.
pub fn compare_goal(
    job: &CaseJob<'_>,
    rows: &Rows,
    goal: &Goal,
    found: &[u32],
    kinds: &[ScalarKind],
    index: usize,
) -> Option<Worst> {
    let values = std::iter::once(&goal.expected.value).chain(&goal.expected.alternatives);
    let terms = facts::term_values(job, rows, index);
    let one =
        |value: &Vec<f64>| compare_one(job, terms, (value, &goal.errors), found, kinds, index);
    values.filter_map(one).min_by(|a, b| a.share().total_cmp(&b.share()))
}

/// Compares with one accepted value. `terms` has the values of the row's formulas. `of` is the
/// accepted value, and for each word an error that is allowed in addition to the terms.
fn compare_one(
    job: &CaseJob<'_>,
    terms: &[f64],
    of: (&[f64], &[f64]),
    found: &[u32],
    kinds: &[ScalarKind],
    index: usize,
) -> Option<Worst> {
    let component = |word: usize| {
        let found = word_value(found[word], kinds[word]);
        let expected = of.0[word];
        let is_float = kinds[word] == ScalarKind::Float;
        let own = of.1.get(word).copied().unwrap_or(0.0);
        let allowed = if is_float {
            tolerance::allowed_error(&job.terms, terms, word, expected) + own
        } else {
            0.0
        };
        Worst {
            row: index,
            word,
            found,
            expected,
            error: component_distance(found, expected, is_float),
            allowed,
        }
    };
    (0..kinds.len()).map(component).max_by(|a, b| a.share().total_cmp(&b.share()))
}

/// The error of a component. For floats, an error up to the smallest normal number counts as 0,
/// since a device may flush subnormal results. The error is infinite if it would be NaN.
pub fn component_distance(found: f64, expected: f64, is_float: bool) -> f64 {
    let error = if found == expected { 0.0 } else { (found - expected).abs() };
    if error.is_nan() {
        f64::INFINITY
    } else if is_float && error <= f64::from(f32::MIN_POSITIVE) {
        0.0
    } else {
        error
    }
}

/// Whether every result is accepted: f32 cannot represent an expected component, or the bound on
/// its error is not finite.
pub fn is_indeterminate(goal: &Goal) -> bool {
    let held = |value: &f64| value.is_finite() && value.abs() <= f64::from(f32::MAX);
    !goal.expected.value.iter().all(held) || !goal.errors.iter().all(|error| error.is_finite())
}

/// Whether rounding may decide a comparison that the case names in `near`.
pub fn is_ambiguous(job: &CaseJob<'_>, row: &[f64]) -> bool {
    job.near.as_ref().is_some_and(|(formula, margin)| formula.scalar(row).abs() <= *margin)
}

/// The largest distance between the results of two languages on one executor, in units in the last
/// place. It is infinite if values differ that are not floats, or are not finite.
pub fn language_parity(job: &CaseJob<'_>, first: &[u32], second: &[u32]) -> f64 {
    let kinds = job.kernel().result_kinds();
    let apart = |((a, b), kind): ((&u32, &u32), &ScalarKind)| {
        let (x, y) = (word_value(*a, *kind), word_value(*b, *kind));
        match kind {
            _ if a == b || x == y || (x.is_nan() && y.is_nan()) => 0.0,
            ScalarKind::Float if x.is_finite() && y.is_finite() => {
                (x - y).abs() / tolerance::ulp_of(x)
            }
            _ => f64::INFINITY,
        }
    };
    first.iter().zip(second).zip(kinds.iter().cycle()).map(apart).fold(0.0, f64::max)
}
