//! A report as text.

use super::{Outcome, Report};
use crate::compose::Language;

const HEADINGS: [&str; 11] =
    ["function", "language", "executor", "inputs", "worst ULP", "worst error", "allowed ULP", "headroom", "ambiguous", "free", "parity ULP"];

/// One line for each function, language and executor.
pub fn table(report: &Report) -> String {
    let rows: Vec<[String; 11]> = std::iter::once(HEADINGS.map(str::to_owned)).chain(report.outcomes.iter().map(row)).collect();
    let width = |column: usize| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..HEADINGS.len()).map(width).collect();
    let line = |row: &[String; 11]| {
        let cells = row.iter().enumerate().map(|(column, cell)| {
            if column < 3 { format!("{cell:<width$}", width = widths[column]) } else { format!("{cell:>width$}", width = widths[column]) }
        });
        cells.collect::<Vec<_>>().join("  ").trim_end().to_owned() + "\n"
    };
    rows.iter().map(line).collect()
}

fn row(outcome: &Outcome) -> [String; 11] {
    let name = format!("{}::{}", outcome.module, outcome.function);
    let head = [name, language(outcome.language).to_owned(), outcome.executor.to_owned()];
    let tail = match &outcome.verdict {
        Err(_) => ["-", "-", "-", "-", "not run", "-", "-", "-"].map(str::to_owned),
        Ok(verdict) => {
            let share = if verdict.passed() {
                verdict.worst.map_or("exact".to_owned(), |worst| headroom(worst.share()))
            } else {
                "FAILED".to_owned()
            };
            let number = |pick: fn(&super::Worst) -> f64| verdict.worst.as_ref().map_or("0".to_owned(), |worst| short(pick(worst)));
            let parity = verdict.parity.map_or("-".to_owned(), short);
            let percent = |rows: usize| format!("{:.2} %", 100.0 * rows as f64 / verdict.inputs.max(1) as f64);
            [
                verdict.inputs.to_string(),
                number(|worst| worst.ulps()),
                number(|worst| worst.error),
                number(|worst| worst.allowed_ulps()),
                share,
                percent(verdict.ambiguous),
                percent(verdict.indeterminate),
                parity,
            ]
        }
    };
    let mut cells = head.into_iter().chain(tail);
    std::array::from_fn(|_| cells.next().unwrap_or_default())
}

/// What failed, each with its smallest input; empty when nothing did.
pub fn failures(report: &Report) -> String {
    let mut text = String::new();
    for outcome in report.outcomes.iter().filter(|outcome| !outcome.passed()) {
        let place = format!(
            "{}::{} ({}, {} on {})",
            outcome.module,
            outcome.function,
            language(outcome.language),
            outcome.executor,
            outcome.adapter
        );
        match &outcome.verdict {
            Err(error) => text += &format!("{place} did not run: {}\n", error.message),
            Ok(verdict) => {
                text += &format!("{place}: {} of {} inputs are off\n", verdict.failing.len(), verdict.inputs);
                if verdict.proves_nothing() {
                    text += "  no input has a value that f32 could hold and the code determines: nothing was tested\n";
                }
                if verdict.too_ambiguous {
                    text += &format!("  {} inputs are ambiguous, more than the case allows\n", verdict.ambiguous);
                }
                for law in verdict.laws.iter().filter(|law| law.broken > 0) {
                    text += &format!("  the law `{}` is broken {} times: {}\n", law.name, law.broken, law.example.as_deref().unwrap_or(""));
                }
                text += verdict.smallest.as_deref().unwrap_or("");
                text += "\n";
            }
        }
    }
    text
}

fn language(language: Language) -> &'static str {
    match language {
        Language::Wesl => "wesl",
        Language::Glsl => "glsl",
    }
}

fn headroom(share: f64) -> String {
    if share == 0.0 { "exact".to_owned() } else { format!("{:.0} %", 100.0 * (1.0 - share)) }
}

/// Three significant digits, without a long tail.
fn short(value: f64) -> String {
    if value == 0.0 {
        "0".to_owned()
    } else if (0.01..10_000.0).contains(&value) {
        format!("{value:.2}")
    } else {
        format!("{value:.2e}")
    }
}
