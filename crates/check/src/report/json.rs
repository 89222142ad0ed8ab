//! `report.json`: every number of a check.

use serde_json::{Value, json};

use super::ReportOrigin;
use crate::check::{CaseVerdict, CheckReport, Outcome, ProfiledInput, Proof, Worst};
use lamplight_diagnostic::escape_controls;

pub fn json_report(report: &CheckReport, origin: &ReportOrigin<'_>) -> String {
    let value = json!({
        "format": 1,
        "version": env!("CARGO_PKG_VERSION"),
        "command": origin.command,
        "passed": report.passed(),
        "outcomes": report.outcomes.iter().map(|one| outcome_json(one, origin)).collect::<Vec<_>>(),
        "proofs": report.proofs.iter().map(|one| proof_json(one, origin)).collect::<Vec<_>>(),
        "untested": report.untested,
    });
    // JSON itself escapes fewer characters than terminals and editors obey.
    escape_controls(&format!("{value:#}\n"))
}

fn outcome_json(outcome: &Outcome, origin: &ReportOrigin<'_>) -> Value {
    let (file, line) = origin.place(outcome.span);
    let (verdict, error) = match &outcome.verdict {
        Ok(found) => (verdict_json(found), Value::Null),
        Err(error) => (Value::Null, json!(error.message)),
    };
    json!({
        "module": outcome.module,
        "function": outcome.function,
        "case": outcome.case,
        "file": file,
        "line": line,
        "language": outcome.language.name(),
        "executor": outcome.executor,
        "adapter": outcome.adapter,
        "passed": outcome.passed(),
        "lacks": outcome.lacks().map(|lack| &lack.message),
        "recorded_share": outcome.recorded,
        "of_driver": outcome.of_driver(),
        "waiver": outcome.waiver.as_ref().map(|(share, reason)| json!({ "share": share, "reason": reason })),
        "verdict": verdict,
        "error": error,
    })
}

fn verdict_json(verdict: &CaseVerdict) -> Value {
    let laws = verdict
        .laws
        .iter()
        .map(|law| json!({ "law": law.name, "broken": law.broken, "example": law.example }));
    let worst_inputs = verdict.profile.iter().flat_map(|profile| &profile.worst);
    json!({
        "inputs": verdict.inputs,
        "indeterminate": verdict.indeterminate,
        "ambiguous": verdict.ambiguous,
        "failing": verdict.failing.len(),
        "parity_ulps": verdict.parity,
        "largest_error": verdict.largest,
        "worst": verdict.worst.as_ref().map(worst_json),
        "worst_inputs": worst_inputs.map(input_json).collect::<Vec<_>>(),
        "laws": laws.collect::<Vec<_>>(),
        "smallest": verdict.smallest,
    })
}

fn worst_json(worst: &Worst) -> Value {
    json!({
        "row": worst.row,
        "component": worst.word,
        "found": worst.found,
        "expected": worst.expected,
        "error": worst.error,
        "allowed": worst.allowed,
        "share": worst.share(),
        "ulps": worst.ulps(),
        "allowed_ulps": worst.allowed_ulps(),
    })
}

fn input_json(input: &ProfiledInput) -> Value {
    let words = input.words.iter().map(|(name, value, bits)| json!({ "name": name, "value": value, "bits": format!("0x{bits:08x}") }));
    json!({ "words": words.collect::<Vec<_>>(), "outcome": worst_json(&input.worst) })
}

fn proof_json(proof: &Proof, origin: &ReportOrigin<'_>) -> Value {
    let (file, line) = origin.place(proof.span);
    let spec = match &proof.spec {
        Ok(spec) => json!({
            "rows": spec.rows,
            "stricter": spec.stricter,
            "least_share": spec.least,
            "stated_ulps": spec.stated_ulps,
            "bound_ulps": spec.bound_ulps,
        }),
        Err(error) => json!({ "error": error }),
    };
    let parity = proof.parity.as_ref().map(|parity| match parity {
        Ok(parity) => {
            json!({ "rows": parity.rows, "apart": parity.apart, "worst_relative": parity.worst })
        }
        Err(error) => json!({ "error": error }),
    });
    let value = proof
        .value
        .map(|value| json!({ "rows": value.rows, "off": value.off, "worst_share": value.share }));
    json!({
        "module": proof.module,
        "function": proof.function,
        "case": proof.case,
        "file": file,
        "line": line,
        "passed": proof.passed(),
        "spec": spec,
        "value": value,
        "parity": parity,
        "arguments": proof.arguments,
    })
}
