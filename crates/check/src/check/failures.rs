//! Turns what failed in a check into diagnostics at the cases.

use super::report::short_number;
use super::{CaseVerdict, CheckReport, Outcome, Proof};
use crate::ratchet::SLACK;
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};

/// What failed in a report, each with its simplest input; empty if nothing did.
pub fn report_failures(report: &CheckReport) -> Diagnostics {
    let proofs = report.proofs.iter().filter_map(of_proof);
    proofs.chain(report.outcomes.iter().filter_map(of_outcome)).collect()
}

/// The failures as plain text, without excerpts of the sources.
pub fn failures_as_text(failures: &[Diagnostic]) -> String {
    let line = |failure: &Diagnostic| {
        let notes: Vec<String> = failure.notes.iter().map(|note| format!("{note}\n")).collect();
        format!("{}\n{}\n", failure.message, notes.concat())
    };
    failures.iter().map(line).collect()
}

/// What fails in a proof.
pub fn of_proof(proof: &Proof) -> Option<Diagnostic> {
    let path = proof.path();
    let mut reasons = Vec::new();
    match &proof.parity {
        Some(Err(error)) => {
            reasons.push(format!("the languages could not be compared in f64: {error}"));
        }
        Some(Ok(parity)) if parity.apart > 0 => reasons.push(format!(
            "WESL and GLSL differ in f64 on {} of {} inputs, by up to {:.1e} of the value",
            parity.apart, parity.rows, parity.worst
        )),
        _ => {}
    }
    if let Some(value) = proof.value.filter(|value| value.off > 0) {
        let (off, rows, share) = (value.off, value.rows, short_number(value.share));
        reasons.push(format!(
            "the code in f64, without any rounding, is off on {off} of {rows} inputs, by up to {share} times what is allowed"
        ));
    }
    let mut reasons = reasons.into_iter();
    let error = failed_check(format!("`{path}`: {}", reasons.next()?));
    let error = reasons.fold(error, Diagnostic::note).at(proof.span, "in this case");
    Some(match &proof.arguments {
        Some(arguments) => error.note(format!("most with {arguments}")),
        None => error,
    })
}

/// What fails in an outcome.
pub fn of_outcome(outcome: &Outcome) -> Option<Diagnostic> {
    if !outcome.failed() {
        return None;
    }
    let of = format!("{}, {} on {}", outcome.language.name(), outcome.executor, outcome.adapter);
    let error = match &outcome.verdict {
        Err(error) => {
            let message = format!("`{}` did not run ({of}): {}", outcome.path(), error.message);
            error
                .notes
                .iter()
                .fold(failed_check(message), |failure, note| failure.note(note.clone()))
        }
        Ok(verdict) => {
            let mut reasons = failure_reasons(outcome, verdict).into_iter();
            let first = reasons.next().unwrap_or_default();
            let error = failed_check(format!("`{}` ({of}): {first}", outcome.path()));
            smallest_failing(verdict).fold(reasons.fold(error, Diagnostic::note), Diagnostic::note)
        }
    };
    Some(error.at(outcome.span, "in this case"))
}

fn failed_check(message: String) -> Diagnostic {
    Diagnostic::error(codes::CHECK_FAILED, message)
}

/// Why a verdict does not pass.
fn failure_reasons(outcome: &Outcome, verdict: &CaseVerdict) -> Vec<String> {
    let mut reasons = Vec::new();
    if !verdict.failing.is_empty() {
        let (off, all) = (verdict.failing.len(), verdict.inputs);
        let are = if off == 1 { "is" } else { "are" };
        reasons.push(format!("{off} of {all} inputs {are} off"));
    }
    if let (true, Some(worst), Some(recorded)) =
        (outcome.exceeds_driver(), verdict.worst, outcome.recorded)
    {
        let (found, limit) = (worst.ulps(), worst.allowed_ulps() * recorded * SLACK);
        let (found, limit) = (short_number(found), short_number(limit));
        reasons.push(format!(
            "error {found} ULP exceeds the recorded limit of this driver, {limit} ULP"
        ));
    }
    if verdict.proves_nothing() {
        reasons.push(
            "no input has a value that f32 could hold and the code determines: nothing was tested"
                .to_owned(),
        );
    }
    if verdict.too_ambiguous {
        let (ambiguous, all) = (verdict.ambiguous, verdict.inputs);
        reasons
            .push(format!("ambiguous for {ambiguous} of {all} inputs: more than the case allows"));
    }
    for law in verdict.laws.iter().filter(|law| law.broken > 0) {
        let times =
            if law.broken == 1 { "once".to_owned() } else { format!("{} times", law.broken) };
        let example = law.example.as_deref().unwrap_or_default();
        reasons.push(format!("the law `{}` is broken {times}: {example}", law.name));
    }
    reasons
}

/// The simplest inputs that fail, each with a case to paste.
fn smallest_failing(verdict: &CaseVerdict) -> impl Iterator<Item = String> {
    let of_laws = verdict.laws.iter().filter_map(|law| law.smallest.as_deref());
    let texts = of_laws.chain(verdict.smallest.as_deref());
    texts.flat_map(|text| text.trim_end().split("\n\n").map(first_part))
}

fn first_part(text: &str) -> String {
    let text = text.trim_end();
    let what =
        if text.starts_with("[[case]]") { "to try it alone" } else { "simplest input found" };
    format!("{what}:\n{text}")
}
