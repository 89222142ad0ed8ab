//! What browsers refuse in WGSL that naga accepts. It is an error where a text is written for
//! browsers, and a warning elsewhere.

use lamplight_compose::Composed;
use lamplight_diagnostic::source::Span;
use lamplight_diagnostic::{Code, Diagnostic, Diagnostics, Severity, codes};
use lamplight_rules::{self as rules, Problem, Rule};

use super::on_large_stack;

/// What browsers refuse in a text in WGSL, in its order. It need not be validated for that. `for_browsers`
/// makes errors of what no filter of the text makes anything else.
pub fn lint_wgsl(composed: &Composed, for_browsers: bool) -> Diagnostics {
    on_large_stack(|| rules::check(&composed.text))
        .iter()
        .filter_map(|problem| describe(composed, problem, for_browsers))
        .collect()
}

/// Whether there is anything to tell of, whatever text it is in.
pub fn has_lints(composed: &Composed) -> bool {
    on_large_stack(|| !rules::check(&composed.text).is_empty())
}

/// The derivatives of a text in GLSL that are taken in non-uniform control flow, by its translation. GPUs
/// give undefined results there, and GLSL allows it. One whose place the text's map does not know is at
/// `main`.
pub fn lint_derivatives(wgsl: &Composed) -> Diagnostics {
    let problems = on_large_stack(|| rules::check(&wgsl.text));
    let derivatives = problems.iter().filter(|problem| problem.rule == Rule::Derivative);
    derivatives.map(|problem| derivative_of_glsl(wgsl, problem)).collect()
}

/// Everything that a lint reports of a text in GLSL, by its translation.
pub fn lint_translation(wgsl: &Composed) -> Diagnostics {
    let problems = on_large_stack(|| rules::check(&wgsl.text));
    let described = problems.iter().filter_map(|problem| match problem.rule {
        Rule::Derivative => Some(derivative_of_glsl(wgsl, problem)),
        _ => describe(wgsl, problem, false),
    });
    described.collect()
}

fn derivative_of_glsl(wgsl: &Composed, problem: &Problem) -> Diagnostic {
    let text = wgsl.text.get(problem.place.range()).unwrap_or_default();
    let (what, help) = match text.starts_with("textureSample") {
        true => (
            "a texture sampled with an implicit level",
            "help: sample before the branch, or give the level or the gradients",
        ),
        false => ("a derivative", "help: take it before the branch"),
    };
    let message = format!("{what} in non-uniform control flow");
    let warning = Diagnostic::warning(codes::NON_UNIFORM_DERIVATIVE, message);
    let main = || wgsl.place_of(wgsl.function("main")?);
    let Some(place) = wgsl.map.lookup(problem.place.range()).or_else(main) else {
        return warning.note(help);
    };
    let warning = warning.at(place, "other fragments of the quad may skip this branch");
    let cause = problem.notes.first().and_then(|(cause, _)| wgsl.map.lookup(cause.range()));
    // A place is that of a statement, and so is its cause: the condition of a branch is in the same one.
    let is_apart = |cause: &Span| {
        !(cause.source == place.source && cause.range().contains(&place.range().start))
    };
    let warning = match cause.filter(is_apart) {
        Some(cause) => warning.at(cause, "differs between fragments"),
        None => warning,
    };
    warning.note(help)
}

/// How a rule is reported.
struct RuleReport {
    code: &'static Code,
    /// What stands at the place.
    label: &'static str,
    help: Option<&'static str>,
}

fn report_of(rule: Rule) -> RuleReport {
    match rule {
        Rule::Derivative => RuleReport {
            code: codes::NON_UNIFORM_DERIVATIVE,
            label: "other fragments of the quad may not get here",
            help: Some("help: do this before the branch, or give the level or the gradients"),
        },
        Rule::Barrier => RuleReport {
            code: codes::NON_UNIFORM_BARRIER,
            label: "other invocations of the workgroup may not get here",
            help: Some("help: do this where all invocations of the workgroup come by"),
        },
        Rule::Subgroup => RuleReport {
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
        | Rule::Constant => RuleReport { code: codes::BROWSERS_REFUSE, label: "here", help: None },
    }
}

fn describe(composed: &Composed, problem: &Problem, for_browsers: bool) -> Option<Diagnostic> {
    let RuleReport { code, label, help } = report_of(problem.rule);
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
    let diagnostic = Diagnostic { severity, ..Diagnostic::error(code, problem.message.clone()) };
    let diagnostic =
        place.into_iter().fold(diagnostic, |diagnostic, span| diagnostic.at(span, label));
    let diagnostic = problem.notes.iter().fold(diagnostic, |diagnostic, (place, note)| {
        match composed.map.lookup(place.range()) {
            Some(span) => diagnostic.at(span, note.clone()),
            None => diagnostic,
        }
    });
    let written =
        written_help(composed.text.get(problem.place.range()).unwrap_or_default(), problem);
    let diagnostic = written.into_iter().fold(diagnostic, Diagnostic::note);
    Some(help.into_iter().fold(diagnostic, |diagnostic, help| diagnostic.note(help)))
}

/// What to write, with the author's own text.
fn written_help(text: &str, problem: &Problem) -> Option<String> {
    match problem.rule {
        Rule::Derivative if text.starts_with("textureSample(") => {
            let level = text.strip_prefix("textureSample")?.strip_suffix(')')?;
            Some(format!(
                "help: write `let texel = {text};` before the branch and `texel` here, or \
                 `textureSampleLevel{level}, 0.0)`"
            ))
        }
        Rule::Derivative if text.ends_with(')') => {
            Some(format!("help: write `let value = {text};` before the branch and `value` here"))
        }
        Rule::Barrier if text.ends_with(')') => Some(format!(
            "help: end the branch with `}}` before it, and write `{text};` after that"
        )),
        Rule::Precedence => bracketed(text, problem.message.split('`').nth(1)?)
            .map(|text| format!("help: write `{text}`")),
        Rule::Behaviour if problem.message.starts_with("this loop never ends") => {
            Some("help: write `if ... { break; }` in it".to_owned())
        }
        Rule::Memory if problem.message.ends_with("that can be written") => {
            Some("help: write `var<storage, read>` if it is only read".to_owned())
        }
        _ => None,
    }
}

/// A text with brackets around both sides of its last operator of a kind, where they are more than one
/// word.
fn bracketed(text: &str, operator: &str) -> Option<String> {
    let mut depth = 0_i32;
    let mut found = None;
    for (at, letter) in text.char_indices() {
        match letter {
            '(' | '[' => depth += 1,
            ')' | ']' => depth -= 1,
            _ if depth == 0 && text[at..].starts_with(operator) => found = Some(at),
            _ => {}
        }
    }
    let at = found?;
    let side = |text: &str| match text.trim() {
        one if one.contains(' ') && !one.starts_with('(') => format!("({one})"),
        one => one.to_owned(),
    };
    Some(format!("{} {operator} {}", side(&text[..at]), side(&text[at + operator.len()..])))
}
