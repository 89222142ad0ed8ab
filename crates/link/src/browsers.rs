//! What becomes of derivatives that filters at statements allow, which naga does not read. Then the output
//! turns the rule off.

use std::sync::Arc;

use super::compile::TextForms;
use lamplight_bundle::Artifact;
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};
use lamplight_emit::without_derivative_rule;
use lamplight_rules::{self as rules, Problem, Rule};
use lamplight_validate::on_large_stack;

/// Turns the rule off in a WGSL output that needs it.
///
/// # Errors
/// Barriers in non-uniform control flow, which no filter allows.
pub fn fit_for_browsers(
    text: &TextForms<'_>,
    entry: &str,
    artifact: &mut Artifact,
) -> Result<(), Diagnostics> {
    let written = String::from_utf8_lossy(&artifact.bytes).into_owned();
    let problems = on_large_stack(|| rules::check(&written));
    let errors: Vec<&Problem> =
        problems.iter().filter(|one| one.severity >= rules::Severity::Default).collect();
    if let Some(problem) = errors.iter().find(|one| one.rule != Rule::Derivative) {
        let message = format!("browsers refuse the output: {}", problem.message);
        let code = match problem.rule {
            Rule::Barrier | Rule::Subgroup => codes::NON_UNIFORM_BARRIER,
            _ => codes::BROWSERS_REFUSE,
        };
        return Err(vec![at_entry(text, entry, Diagnostic::error(code, message))]);
    }
    if !errors.is_empty() {
        artifact.bytes = Arc::from(without_derivative_rule(&written).into_bytes());
    }
    Ok(())
}

fn at_entry(text: &TextForms<'_>, entry: &str, diagnostic: Diagnostic) -> Diagnostic {
    let function = text.composed.function(entry);
    match function.and_then(|function| text.composed.place_of(function)) {
        Some(span) => diagnostic.at(span, "in this entry point, or in what it calls"),
        None => diagnostic,
    }
}
