//! Compares measured values with those of a record.

use std::fmt::Write as _;

use naga::ScalarKind;

use super::{MeasuredCase, RecordedCase, RecordedRow, ValueRecord};
use crate::check::profile::value_text;
use crate::check::{short_number, verdict};
use crate::tolerance;
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};
use lamplight_execute::kernel::word_value;

/// What differs, each list in the order of names and languages.
#[derive(Debug, Default)]
pub struct ValueComparison {
    /// Functions that the record does not have, and new cases of others.
    pub added: Vec<String>,
    /// Functions of the record that there are no more, and gone cases of others.
    pub gone: Vec<String>,
    /// Changed signatures: the case, the older signature, the one of today.
    pub signatures: Vec<(String, String, String)>,
    /// Cases whose textures or samplers are others, so that their values say nothing.
    pub fixtures: Vec<String>,
    pub changes: Vec<ValueChange>,
    /// How many cases were compared.
    pub compared: usize,
}

/// A case with other values.
#[derive(Debug)]
pub struct ValueChange {
    pub title: String,
    /// How many of the recorded inputs give another value, and how many were compared.
    pub differing: usize,
    pub rows: usize,
    /// The largest differences: in units in the last place, relative, and as a share of the
    /// tolerance.
    pub ulps: f64,
    pub relative: f64,
    pub share: f64,
    /// The input with the largest share, and its values.
    pub example: String,
    /// The failure, if the change is larger than the tolerance.
    pub failure: Option<Diagnostic>,
}

/// The difference of one component.
struct Difference {
    kind: ScalarKind,
    old: f64,
    new: f64,
    ulps: f64,
    relative: f64,
    share: f64,
}

impl ValueComparison {
    /// The changes that are larger than the recorded tolerances.
    pub fn failures(&self) -> Diagnostics {
        self.changes.iter().filter_map(|change| change.failure.clone()).collect()
    }

    /// A line for each difference, and one that counts them.
    pub fn text(&self) -> String {
        let mut text = String::new();
        self.added.iter().for_each(|title| push_line(&mut text, "new", title));
        self.gone.iter().for_each(|title| push_line(&mut text, "gone", title));
        for (title, old, new) in &self.signatures {
            push_line(&mut text, "signature", &format!("{title}: {old} before, {new} now"));
        }
        for title in &self.fixtures {
            push_line(&mut text, "fixtures", &format!("{title}: other textures, not compared"));
        }
        self.changes.iter().for_each(|change| push_line(&mut text, "values", &change.text()));
        let beyond = self.changes.iter().filter(|change| change.failure.is_some()).count();
        let within = self.changes.len() - beyond;
        let same = self.compared - self.changes.len();
        let _ = writeln!(
            text,
            "{} compared: {same} the same, {within} changed within the tolerance, {beyond} beyond it",
            self.compared
        );
        text
    }
}

impl ValueChange {
    fn text(&self) -> String {
        let Self { title, differing, rows, ulps, relative, share, example, failure: _ } = self;
        let (ulps, relative) = (short_number(*ulps), short_number(*relative));
        let share = short_number(*share);
        format!(
            "{title}: {differing} of {rows} inputs, by up to {ulps} ULP, relative {relative}, {share} of the tolerance; {example}"
        )
    }
}

fn push_line(text: &mut String, kind: &str, line: &str) {
    let _ = writeln!(text, "{kind:<9}  {line}");
}

/// Compares. `is_wanted` says whether a case of the record belongs to what was measured, so that it
/// is gone if it was not.
pub fn compare_values(
    old: &ValueRecord,
    measured: &[MeasuredCase],
    is_wanted: impl Fn(&RecordedCase) -> bool,
) -> Result<ValueComparison, Diagnostic> {
    let mut comparison = ValueComparison::default();
    let is_gone = |case: &&RecordedCase| {
        is_wanted(case) && !measured.iter().any(|new| new.case.is_same_case(case))
    };
    for case in old.cases.iter().filter(is_gone) {
        let mut known = measured.iter().map(|new| &new.case);
        push_once(&mut comparison.gone, case.title_among(&mut known));
    }
    for new in measured {
        let title = new.case.title();
        match old.find(&new.case) {
            None => {
                push_once(&mut comparison.added, new.case.title_among(&mut old.cases.iter()));
            }
            Some(known) if known.signature != new.case.signature => {
                let (before, now) = (known.signature.clone(), new.case.signature.clone());
                comparison.signatures.push((title, before, now));
            }
            Some(known) if known.fixtures != new.case.fixtures => comparison.fixtures.push(title),
            Some(known) => {
                comparison.compared += 1;
                comparison.changes.extend(changed_case(known, new)?);
            }
        }
    }
    Ok(comparison)
}

fn push_once(titles: &mut Vec<String>, title: String) {
    if !titles.contains(&title) {
        titles.push(title);
    }
}

fn changed_case(old: &RecordedCase, new: &MeasuredCase) -> Result<Option<ValueChange>, Diagnostic> {
    let mut change = ValueChange {
        title: old.title(),
        differing: 0,
        rows: old.rows.len(),
        ulps: 0.0,
        relative: 0.0,
        share: 0.0,
        example: String::new(),
        failure: None,
    };
    for (row, new_row) in old.rows.iter().zip(&new.case.rows) {
        if new_row.results.len() != row.results.len() || row.results.len() != new.kinds.len() {
            let message = format!(
                "the record is damaged: a row of `{}` does not have the words of its signature",
                old.name
            );
            let error = Diagnostic::error(codes::RECORD_SYNTAX, message);
            return Err(error.note(format!("the signature is `{}`", old.signature)));
        }
        let found = differences(row, &new_row.results, &new.kinds);
        change.differing += usize::from(!found.is_empty());
        for difference in found {
            change.ulps = change.ulps.max(difference.ulps);
            change.relative = change.relative.max(difference.relative);
            if difference.share > change.share || change.example.is_empty() {
                change.share = difference.share;
                change.example = example_text(new, row, &difference);
            }
        }
    }
    if change.share > 1.0 {
        let (name, language) = (&old.name, old.language.name());
        let message = format!("`{name}` ({language}) has other values than recorded");
        let error = Diagnostic::error(codes::VALUES_CHANGED, message).at(new.span, "in this case");
        change.failure = Some(error.note(change.example.clone()));
    }
    Ok((change.differing > 0).then_some(change))
}

fn example_text(case: &MeasuredCase, row: &RecordedRow, difference: &Difference) -> String {
    let input = |((name, kind), word): (&(String, ScalarKind), &u32)| {
        format!("{name} = {}", value_text(word_value(*word, *kind), *kind))
    };
    let inputs: Vec<String> = case.inputs.iter().zip(&row.inputs).map(input).collect();
    let (old, new) =
        (value_text(difference.old, difference.kind), value_text(difference.new, difference.kind));
    match inputs[..] {
        [] => format!("{old} before, {new} now"),
        _ => format!("for {}: {old} before, {new} now", inputs.join(", ")),
    }
}

/// The components that differ.
fn differences(old: &RecordedRow, new: &[u32], kinds: &[ScalarKind]) -> Vec<Difference> {
    let pairs = old.results.iter().zip(new).zip(kinds).zip(&old.allowed);
    pairs
        .filter(|(((old, new), _), _)| old != new)
        .filter_map(|(((old, new), kind), allowed)| {
            let (old, new) = (word_value(*old, *kind), word_value(*new, *kind));
            let is_float = *kind == ScalarKind::Float;
            if old == new || (old.is_nan() && new.is_nan()) {
                return None;
            }
            let error = verdict::component_distance(new, old, is_float);
            let smallest = f64::from(f32::MIN_POSITIVE);
            Some(Difference {
                kind: *kind,
                old,
                new,
                ulps: if is_float { error / tolerance::ulp_of(old) } else { error },
                relative: error / old.abs().max(smallest),
                share: if error == 0.0 { 0.0 } else { error / allowed },
            })
        })
        .collect()
}
