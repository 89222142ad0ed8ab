//! What browsers refuse in WGSL that naga accepts. It is an error where a text is written for
//! browsers, and a warning elsewhere.

use lamplight_bundle::Language;
use lamplight_compose::Composed;
use lamplight_diagnostic::{Code, Diagnostic, Diagnostics, Severity, codes};
use lamplight_rules::{self as rules, Problem, Rule};

use super::{Validated, on_large_stack, uniformity};

/// What browsers refuse in a text, in its order. For GLSL these are warnings about derivatives.
/// `for_browsers` makes errors of what no filter of the text makes anything else.
pub fn lint(composed: &Composed, validated: &Validated, for_browsers: bool) -> Diagnostics {
    match composed.language {
        Language::Glsl => uniformity::lint(composed, validated),
        Language::Wesl => lint_wgsl(composed, for_browsers),
    }
}

/// The same for WGSL, which need not be validated for that.
pub fn lint_wgsl(composed: &Composed, for_browsers: bool) -> Diagnostics {
    on_large_stack(|| rules::check(&composed.text))
        .iter()
        .filter_map(|problem| describe(composed, problem, for_browsers))
        .collect()
}

/// Whether there is anything to tell of, whatever text it is in.
pub fn has_lints(composed: &Composed, validated: &Validated) -> bool {
    match composed.language {
        Language::Glsl => uniformity::has_lints(validated),
        Language::Wesl => on_large_stack(|| !rules::check(&composed.text).is_empty()),
    }
}

/// How a rule is told.
struct Telling {
    code: &'static Code,
    /// What stands at the place.
    label: &'static str,
    help: Option<&'static str>,
}

fn telling(rule: Rule) -> Telling {
    match rule {
        Rule::Derivative => Telling {
            code: codes::NON_UNIFORM_DERIVATIVE,
            label: "other fragments of the quad may not get here",
            help: Some("help: do this before the branch, or give the level or the gradients"),
        },
        Rule::Barrier => Telling {
            code: codes::NON_UNIFORM_BARRIER,
            label: "other invocations of the workgroup may not get here",
            help: Some("help: do this where all invocations of the workgroup get"),
        },
        Rule::Subgroup => Telling {
            code: codes::NON_UNIFORM_BARRIER,
            label: "other invocations of the subgroup may not get here",
            help: None,
        },
        Rule::Grammar
        | Rule::Depth
        | Rule::Precedence
        | Rule::Behaviour
        | Rule::Memory
        | Rule::Attribute
        | Rule::Constant => Telling { code: codes::BROWSERS_REFUSE, label: "here", help: None },
    }
}

fn describe(composed: &Composed, problem: &Problem, for_browsers: bool) -> Option<Diagnostic> {
    let Telling { code, label, help } = telling(problem.rule);
    let severity = match problem.severity {
        rules::Severity::Off => return None,
        rules::Severity::Default if for_browsers => Severity::Error,
        rules::Severity::Error => Severity::Error,
        rules::Severity::Info | rules::Severity::Warning | rules::Severity::Default => {
            Severity::Warning
        }
    };
    let place = composed.map.lookup(problem.place.range());
    // A lean text has no places at all.
    if place.is_none() && !composed.map.is_empty() {
        return None;
    }
    let told = Diagnostic { severity, ..Diagnostic::error(code, problem.message.clone()) };
    let told = place.into_iter().fold(told, |told, span| told.at(span, label));
    let told = problem.notes.iter().fold(told, |told, (place, note)| {
        match composed.map.lookup(place.range()) {
            Some(span) => told.at(span, note.clone()),
            None => told,
        }
    });
    Some(help.into_iter().fold(told, |told, help| told.note(help)))
}
