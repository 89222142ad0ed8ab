//! `errors.md`: the worst error of each function on each executor, to keep as documentation of a
//! driver.

use std::fmt::Write as _;

use super::{ReportOrigin, executors_of, functions_of};
use crate::check::{CheckReport, Outcome, short_number};
use lamplight_diagnostic::escape_markup;

/// The report as a table in Markdown.
pub fn error_table(report: &CheckReport, origin: &ReportOrigin<'_>) -> String {
    let executors = executors_of(report);
    let mut text = format!(
        "# Worst errors\n\nMeasured by Lamplight {} with <code>{}</code>.\n\n\
         | executor | adapter and driver | pass | fail | cannot run |\n|---|---|---|---|---|\n",
        env!("CARGO_PKG_VERSION"),
        cell(&origin.command)
    );
    for (executor, adapter) in &executors {
        let own = || report.outcomes.iter().filter(|outcome| outcome.executor == *executor);
        let failed = own().filter(|outcome| outcome.failed()).count();
        let lacking = own().filter(|outcome| outcome.lacks().is_some()).count();
        let passed = own().count() - failed - lacking;
        let adapter = cell(adapter);
        let _ = writeln!(text, "| {executor} | {adapter} | {passed} | {failed} | {lacking} |");
    }
    text += "\nA row has the largest error of all cases, inputs and languages. The first number is the absolute\n\
             error. The second is the largest share of the tolerance that an input needed.\n\n| function |";
    executors.iter().for_each(|(executor, _)| text += &format!(" {executor} |"));
    text += &format!("\n|---|{}\n", "---|".repeat(executors.len()));
    for (path, outcomes) in functions_of(report) {
        let _ = write!(text, "| <code>{}</code> |", cell(&path));
        for (executor, _) in &executors {
            let own = outcomes.iter().copied().filter(|outcome| outcome.executor == *executor);
            let _ = write!(text, " {} |", worst_text(&own.collect::<Vec<_>>()));
        }
        text.push('\n');
    }
    text
}

/// The largest error and share of a function on an executor, in all cases and languages, and whether
/// one of them fails.
fn worst_text(outcomes: &[&Outcome]) -> String {
    let failed = outcomes.iter().any(|outcome| outcome.failed());
    let verdicts: Vec<_> =
        outcomes.iter().filter_map(|outcome| outcome.verdict.as_ref().ok()).collect();
    if verdicts.is_empty() {
        return if failed { "**FAILED**" } else { "cannot run" }.to_owned();
    }
    let error = verdicts.iter().map(|verdict| verdict.largest).fold(0.0, f64::max);
    let shares = verdicts.iter().filter_map(|verdict| verdict.worst.as_ref());
    let share = shares.map(|worst| worst.share()).fold(0.0, f64::max);
    let numbers = match share {
        0.0 => "exact".to_owned(),
        _ => format!("{}, {:.0} %", short_number(error), 100.0 * share),
    };
    if failed { format!("**FAILED** {numbers}") } else { numbers }
}

/// A text that ends neither its cell nor the elements around it.
fn cell(text: &str) -> String {
    escape_markup(text).replace('|', "&#124;").replace('`', "&#96;").replace('\n', " ")
}
