//! Checks the laws of a case.

use super::job::{CaseJob, Goal};
use super::{facts, profile, verdict};
use crate::cases::Rows;
use crate::laws::{self, Integral, Law};
use crate::tolerance;
use lamplight_execute::kernel::word_value;
use naga::ScalarKind;

/// The result of checking a law.
#[derive(Debug)]
pub struct LawVerdict {
    pub name: &'static str,
    /// How often it is broken: most laws count each component of each row.
    pub broken: usize,
    /// A description of the first violation.
    pub example: Option<String>,
    /// The first row that breaks it, if a single row can break it.
    pub row: Option<usize>,
    /// A small input that breaks it, with a case to paste.
    pub smallest: Option<String>,
}

/// Rows with their results.
#[derive(Clone, Copy)]
pub struct RowResults<'a> {
    pub rows: &'a Rows,
    /// The expected value of each row, if that is known.
    pub expected: &'a [Goal],
    pub results: &'a [u32],
    /// The rows that the law compares with, and their results.
    pub transformed: Option<(&'a Rows, &'a [u32])>,
}

impl LawVerdict {
    pub fn new(law: &Law) -> Self {
        Self { name: law.kind.name, broken: 0, example: None, row: None, smallest: None }
    }
}

/// Checks one law over all rows.
pub fn check_law(job: &CaseJob<'_>, law: &Law, given: &RowResults<'_>) -> LawVerdict {
    let kinds = job.kernel().result_kinds();
    match (law.kind.name, &law.integral, given.transformed) {
        ("reaches", ..) => check_reaches(law, given.results, &kinds),
        (laws::FINITE, ..) => check_finite(job, law, given, &kinds),
        (_, Some(rule), Some((rows, found))) => {
            check_integral(job, law, rule, (rows, found), &kinds)
        }
        _ => check_each(job, law, given, &kinds),
    }
}

/// Checks a law about single rows, or about a row and its transformed row.
fn check_each(
    job: &CaseJob<'_>,
    law: &Law,
    given: &RowResults<'_>,
    kinds: &[ScalarKind],
) -> LawVerdict {
    let mut verdict = LawVerdict::new(law);
    for index in 0..given.rows.len() {
        let row = given.rows.row(index);
        let other_row = given.transformed.map(|(rows, _)| rows.row(index));
        let goal = given.expected.get(index);
        if is_left_out(job, given, index) {
            continue;
        }
        let values = facts::term_values(job, given.rows, index);
        let moved = other_row.map_or(0.0, |other| input_distance(row, other));
        for (word, kind) in kinds.iter().enumerate().filter(|(_, kind)| **kind != ScalarKind::Bool)
        {
            let at = index * kinds.len() + word;
            let value = word_value(given.results[at], *kind);
            let other = given.transformed.map(|(_, words)| word_value(words[at], *kind));
            let allowed = if other.is_some() {
                let own = goal.and_then(|goal| goal.errors.get(word)).copied().unwrap_or(0.0);
                let compared =
                    if law.kind.takes == laws::Takes::Point { law.number(word) } else { value };
                2.0 * (tolerance::allowed_error(&job.terms, values, word, compared) + own)
                    + f64::from(f32::MIN_POSITIVE)
            } else {
                0.0
            };
            let broken = laws::broken_by(law, value, other, moved, word);
            if value.is_nan() || other.is_some_and(f64::is_nan) || broken > allowed {
                verdict.broken += 1;
                verdict.row.get_or_insert(index);
                let text = || {
                    let compared = other.map_or(String::new(), |other| {
                        format!(", and {other} for the inputs that the law compares with")
                    });
                    let (broken, allowed) = (amount_text(broken), amount_text(allowed));
                    let row = profile::arguments_text(job, row);
                    format!("{row} gives {value}{compared}: off by {broken}, allowed {allowed}")
                };
                verdict.example.get_or_insert_with(text);
            }
        }
    }
    verdict
}

/// Whether the law says nothing about a row: its transformed row is outside of the case's filter,
/// every result is accepted, or rounding may decide a comparison.
fn is_left_out(job: &CaseJob<'_>, given: &RowResults<'_>, index: usize) -> bool {
    given.transformed.is_some_and(|(rows, _)| !facts::is_inside(job, rows, index))
        || given.expected.get(index).is_some_and(verdict::is_indeterminate)
        || facts::is_ambiguous(job, given.rows, index)
}

/// An error in scientific notation; `0` for none.
pub fn amount_text(value: f64) -> String {
    if value == 0.0 { "0".to_owned() } else { format!("{value:.2e}") }
}

/// The Euclidean distance between the inputs of two rows.
fn input_distance(row: &[f64], other: &[f64]) -> f64 {
    row.iter().zip(other).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
}

fn check_integral(
    job: &CaseJob<'_>,
    law: &Law,
    rule: &Integral,
    (rows, found): (&Rows, &[u32]),
    kinds: &[ScalarKind],
) -> LawVerdict {
    let mut verdict = LawVerdict::new(law);
    if rows.is_empty() {
        verdict.broken = 1;
        verdict.example = Some("no row has a unit vector to integrate about".to_owned());
    }
    for word in 0..kinds.len() {
        let values: Vec<f64> =
            found.chunks(kinds.len()).map(|words| word_value(words[word], kinds[word])).collect();
        for (index, sum) in rule.sums(&values).into_iter().enumerate() {
            let (wanted, off) = (law.number(word), rule.off(sum, law.number(word)));
            if off <= rule.within {
                continue;
            }
            verdict.broken += 1;
            let row = rows.row(index * rule.calls());
            let most = if rule.at_most { "at most " } else { "" };
            let text = || {
                let (row, off) = (profile::arguments_text(job, row), amount_text(off));
                format!(
                    "over all `{}`, else with {row}, it is {sum}, expected {most}{wanted}: off by {off}",
                    law.names[0]
                )
            };
            verdict.example.get_or_insert_with(text);
        }
    }
    verdict
}

/// Checks the law `finite` for its own rows and, unless it has a `where`, for the case's rows. Rows
/// with arguments above the law's magnitude are skipped.
fn check_finite(
    job: &CaseJob<'_>,
    law: &Law,
    given: &RowResults<'_>,
    kinds: &[ScalarKind],
) -> LawVerdict {
    let mut verdict = LawVerdict::new(law);
    let mut check = |rows: &Rows, found: &[u32]| {
        for (index, words) in found.chunks(kinds.len().max(1)).enumerate() {
            let values = words.iter().zip(kinds).map(|(word, kind)| word_value(*word, *kind));
            let row = rows.row(index);
            let is_meant = row.iter().zip(&rows.kinds).all(|(argument, kind)| {
                *kind != ScalarKind::Float || argument.abs() <= law.number(0)
            });
            let Some(value) = values.clone().find(|value| !value.is_finite() && is_meant) else {
                continue;
            };
            verdict.broken += 1;
            verdict.example.get_or_insert_with(|| {
                format!("{} gives {value}", profile::arguments_text(job, row))
            });
        }
    };
    if let Some((rows, found)) = given.transformed {
        check(rows, found);
    }
    if law.filter.is_none() {
        check(given.rows, given.results);
    }
    verdict
}

fn check_reaches(law: &Law, results: &[u32], kinds: &[ScalarKind]) -> LawVerdict {
    let mut verdict = LawVerdict::new(law);
    let values =
        || results.iter().zip(kinds.iter().cycle()).map(|(word, kind)| word_value(*word, *kind));
    let (least, most) =
        (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max));
    if let [low, high] = law.numbers[..]
        && (least > low || most < high)
    {
        verdict.broken = 1;
        verdict.example =
            Some(format!("values lie in [{least}, {most}], expected to reach [{low}, {high}]"));
    }
    verdict
}
