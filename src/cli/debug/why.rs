//! Prints what made a value.

use std::io::Write as _;

use lamplight_debug::{
    Cause, Subject, SubjectText, Why, WhyError, diagnosed, digits_text, number_json,
    statement_place, statement_text, why,
};
use serde_json::json;

use super::Arguments;
use crate::cli::failure::Failure;
use crate::cli::terminal::stdout;
use crate::diagnostic::nearest_name;

pub fn report_why(
    arguments: &Arguments,
    asked: &str,
    text: SubjectText<'_>,
    subject: &Subject,
) -> Result<(), Failure> {
    let found = why(subject, asked).map_err(|error| refusal(asked, error, text))?;
    if arguments.render.is_json() {
        return print_json(asked, &found, text, subject);
    }
    print_table(asked, &found, text, subject)
}

fn refusal(asked: &str, error: WhyError, text: SubjectText<'_>) -> Failure {
    match error {
        WhyError::Run(error) => {
            Failure::Input(text.sources.clone(), vec![diagnosed(&error, text.map)])
        }
        WhyError::Several(parts) => Failure::input(format!(
            "`--why {asked}` names no single number\nhelp: there are {}",
            parts.join(", ")
        )),
        WhyError::Unknown(names) => {
            let name = asked.split(['.', '[']).next().unwrap_or_default();
            let hint = match nearest_name(name, names.iter().map(String::as_str)) {
                Some(nearest) => format!("did you mean `{nearest}`?"),
                None => format!("there are {}", names.join(", ")),
            };
            Failure::input(format!("no variable of this run is named `{name}`\nhelp: {hint}"))
        }
    }
}

fn print_table(
    asked: &str,
    found: &Why,
    text: SubjectText<'_>,
    subject: &Subject,
) -> Result<(), Failure> {
    let mut out = stdout();
    writeln!(out, "{asked} is {}", digits_text(found.value, 9))?;
    let (mut inputs, lines): (Vec<&Cause>, Vec<&Cause>) =
        found.causes.iter().partition(|cause| cause.statement.is_none());
    let weight = |cause: &Cause| cause.share.or(cause.slope).unwrap_or(0.0).abs();
    inputs.sort_by(|one, other| weight(other).total_cmp(&weight(one)));
    writeln!(out, "\ninputs")?;
    if inputs.is_empty() {
        writeln!(out, "         none: every number that it was made of is in the text")?;
    }
    for cause in inputs {
        writeln!(out, "       {}", cause_text(cause))?;
    }
    let mut last = None;
    let mut path = "";
    for cause in lines {
        let statement = cause.statement.and_then(|id| subject.statements.get(id));
        if let Some(statement) = statement.filter(|_| last != Some((cause.statement, cause.depth)))
        {
            let own = &text.sources.get(statement.span.source).path;
            if own != path {
                path = own;
                writeln!(out, "{path}")?;
            }
            let indent = "  ".repeat(cause.depth);
            let shown = statement_text(text.sources.text(statement.span));
            writeln!(out, "{:>5}  {indent}{shown}", statement.line)?;
        }
        last = Some((cause.statement, cause.depth));
        writeln!(out, "       {}{}", "  ".repeat(cause.depth), cause_text(cause))?;
    }
    if found.is_cut {
        writeln!(out, "\nThere are more numbers than these.")?;
    }
    Ok(())
}

/// The name, the value and the share of a number.
fn cause_text(cause: &Cause) -> String {
    let mut parts = Vec::new();
    match (cause.share, cause.slope) {
        (Some(share), _) => parts.push(format!("share {} %", signed(100.0 * share))),
        (None, Some(0.0)) => parts.push("no change for a small change".to_owned()),
        (None, Some(slope)) => parts.push(format!("{} for each 1 more", signed(slope))),
        (None, None) => {}
    }
    if !cause.instead.is_empty() {
        let instead = cause.instead.join(", ");
        let none = if cause.slope.is_none() { ": no derivative" } else { "" };
        parts.push(format!("{instead}{none}"));
    }
    let parts = parts.join("; ");
    match cause.value {
        Some(value) => format!("  {:<16} {:<14} {parts}", cause.name, digits_text(value, 7)),
        None => format!("  {parts}"),
    }
}

fn signed(number: f64) -> String {
    let sign = if number > 0.0 { "+" } else { "" };
    format!("{sign}{}", digits_text(number, 3))
}

fn print_json(
    asked: &str,
    found: &Why,
    text: SubjectText<'_>,
    subject: &Subject,
) -> Result<(), Failure> {
    let cause = |cause: &Cause| {
        json!({
            "at": statement_place(subject, text.sources, cause.statement),
            "depth": cause.depth,
            "name": cause.name,
            "value": cause.value.map(number_json),
            "slope": cause.slope.map(number_json),
            "share": cause.share.map(number_json),
            "instead": cause.instead,
        })
    };
    let causes: Vec<_> = found.causes.iter().map(cause).collect();
    let value = json!({
        "asked": asked,
        "value": number_json(found.value),
        "causes": causes,
        "complete": !found.is_cut,
    });
    Ok(writeln!(stdout(), "{value}")?)
}
