//! Writes a report as text.

use super::{CheckReport, Outcome, Proof};

const HEADINGS: [&str; COLUMNS] = [
    "function",
    "language",
    "executor",
    "inputs",
    "worst error",
    "ULP",
    "of allowed",
    "headroom",
    "driver",
    "ambiguous",
    "free",
    "parity ULP",
];
const COLUMNS: usize = 12;

/// One line for each function, language and executor.
pub fn report_table(report: &CheckReport) -> String {
    let rows: Vec<[String; COLUMNS]> = std::iter::once(HEADINGS.map(str::to_owned))
        .chain(report.outcomes.iter().map(table_row))
        .collect();
    let width =
        |column: usize| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..HEADINGS.len()).map(width).collect();
    let line = |row: &[String; COLUMNS]| {
        let cells = row.iter().enumerate().map(|(column, cell)| {
            if column < 3 {
                format!("{cell:<width$}", width = widths[column])
            } else {
                format!("{cell:>width$}", width = widths[column])
            }
        });
        cells.collect::<Vec<_>>().join("  ").trim_end().to_owned() + "\n"
    };
    rows.iter().map(line).collect()
}

fn table_row(outcome: &Outcome) -> [String; COLUMNS] {
    let name = format!("{}::{}", outcome.module, outcome.function);
    let head = [name, outcome.language.name().to_owned(), outcome.executor.to_owned()];
    let tail = match &outcome.verdict {
        Err(_) => {
            let headroom = if outcome.lacks().is_some() { "cannot run" } else { "not run" };
            ["-", "-", "-", "-", headroom, "-", "-", "-", "-"].map(str::to_owned)
        }
        Ok(verdict) => {
            let share = if outcome.passed() {
                verdict.worst.map_or("exact".to_owned(), |worst| headroom_text(worst.share()))
            } else {
                "FAILED".to_owned()
            };
            let number = |pick: fn(&super::Worst) -> f64| {
                verdict.worst.as_ref().map_or("0".to_owned(), |worst| short_number(pick(worst)))
            };
            let percent = |rows: usize| {
                format!("{:.2} %", 100.0 * rows as f64 / verdict.inputs.max(1) as f64)
            };
            [
                verdict.inputs.to_string(),
                short_number(verdict.largest),
                number(|worst| worst.ulps()),
                number(|worst| worst.allowed_ulps()),
                share,
                outcome
                    .of_driver()
                    .map_or("-".to_owned(), |share| format!("{:.0} %", 100.0 * share)),
                percent(verdict.ambiguous),
                percent(verdict.indeterminate),
                verdict.parity.map_or("-".to_owned(), short_number),
            ]
        }
    };
    let mut cells = head.into_iter().chain(tail);
    std::array::from_fn(|_| cells.next().unwrap_or_default())
}

/// The cases whose tolerance is below what WGSL allows their code, one line for each.
pub fn stricter_cases(report: &CheckReport) -> String {
    let line = |proof: &Proof| {
        let spec = proof.spec.as_ref().ok().filter(|spec| spec.stricter > 0)?;
        let (name, rows) = (format!("{}::{}", proof.module, proof.function), spec.rows);
        let (stated, bound) = (short_number(spec.stated_ulps), short_number(spec.bound_ulps));
        Some(format!(
            "{name} (case {}): {stated} ULP are stated where WGSL allows {bound}, on {} of {rows} inputs less\n",
            proof.case + 1,
            spec.stricter
        ))
    };
    report.proofs.iter().filter_map(line).collect()
}

/// What executors cannot run, with the reason, one line for each.
pub fn lacking_text(report: &CheckReport) -> String {
    let line = |outcome: &Outcome| {
        let (reason, case) = (&outcome.lacks()?.message, outcome.case + 1);
        let (path, language) = (outcome.path(), outcome.language.name());
        Some(format!("{path} (case {case}, {language} on {}): {reason}\n", outcome.executor))
    };
    report.outcomes.iter().filter_map(line).collect()
}

/// How much of the tolerance the error leaves, in percent; `exact` without an error.
pub fn headroom_text(share: f64) -> String {
    if share == 0.0 { "exact".to_owned() } else { format!("{:.0} %", 100.0 * (1.0 - share)) }
}

/// A few significant digits, without a long tail.
pub fn short_number(value: f64) -> String {
    if value == 0.0 {
        "0".to_owned()
    } else if (0.01..10_000.0).contains(&value.abs()) {
        format!("{value:.2}")
    } else {
        format!("{value:.2e}")
    }
}
