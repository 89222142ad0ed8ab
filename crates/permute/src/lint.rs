//! Lints of a space: constraints that are always true or always false, and values and slices that
//! no permutation has. All of these are allowed. Few authors mean them.

use super::axis::{Axis, ValueSet};
use super::space::{Constraint, Slice, Space};
use lamplight_diagnostic::source::Span;
use lamplight_diagnostic::{Diagnostic, codes};
use lamplight_files::limits::{SPACE_STEPS, Steps};

/// Warnings about a space; `what` and `place` name its program.
pub fn lint(space: &Space, what: &str, place: Span) -> Vec<Diagnostic> {
    let mut warnings: Vec<Diagnostic> = trivial_constraints(space);
    if space.valid_count() == 0
        && warnings.iter().any(|warning| warning.code == codes::CONSTRAINT_ALWAYS_FALSE)
    {
        return warnings;
    }
    if space.valid_count() == 0 {
        let message = format!("no permutation of {what} satisfies all constraints");
        warnings.push(
            Diagnostic::warning(codes::NO_PERMUTATION, message).at(place, "has no permutation"),
        );
        return warnings;
    }
    warnings.extend(
        space
            .axes()
            .iter()
            .zip(space.valid_values())
            .flat_map(|(axis, valid)| never_valid(axis, valid)),
    );
    let most = SPACE_STEPS as usize / space.steps_of_meeting().max(1);
    warnings
        .extend(space.lists().only.iter().take(most).filter_map(|slice| empty_slice(space, slice)));
    warnings.extend(nothing_wanted(space, what, place));
    warnings
}

/// The warning for a space in which the lists leave no permutation.
pub fn nothing_wanted(space: &Space, what: &str, place: Span) -> Option<Diagnostic> {
    (space.count() == 0).then(|| {
        let message = format!("the lists of {what} leave no permutation");
        Diagnostic::warning(codes::NO_PERMUTATION, message).at(place, "ships empty")
    })
}

/// Warnings about conditions that always have the same value. They share a limit on steps, and
/// conditions beyond it are not looked at.
fn trivial_constraints(space: &Space) -> Vec<Diagnostic> {
    let mut steps = Steps::new(SPACE_STEPS);
    let constraints = space.constraints().iter();
    constraints.filter_map(|constraint| trivial_constraint(space, constraint, &mut steps)).collect()
}

fn trivial_constraint(
    space: &Space,
    constraint: &Constraint,
    steps: &mut Steps,
) -> Option<Diagnostic> {
    let satisfying = space.satisfying(&constraint.formula, steps).ok()?;
    let (code, word) = match satisfying {
        0 => (codes::CONSTRAINT_ALWAYS_FALSE, "false"),
        all if all == space.full_count() => (codes::CONSTRAINT_ALWAYS_TRUE, "true"),
        _ => return None,
    };
    let warning =
        Diagnostic::warning(code, format!("the constraint `{}` is always {word}", constraint.text));
    let warning = warning.at(constraint.span, format!("{word} whatever the axes are"));
    Some(if satisfying == 0 { warning.note("so the program ships empty") } else { warning })
}

fn never_valid(axis: &Axis, valid: ValueSet) -> Option<Diagnostic> {
    let never: Vec<String> = axis
        .domain()
        .without(valid)
        .iter()
        .map(|ordinal| format!("`{}`", axis.values[ordinal]))
        .collect();
    let (subject, label) = match never.as_slice() {
        [] => return None,
        [value] => (
            format!("value {value} of axis `{}` is", axis.name),
            "the constraints rule this value out",
        ),
        values => (
            format!("values {} of axis `{}` are", values.join(", "), axis.name),
            "the constraints rule these values out",
        ),
    };
    Some(
        Diagnostic::warning(codes::VALUE_NEVER_VALID, format!("{subject} in no valid permutation"))
            .at(axis.span, label),
    )
}

fn empty_slice(space: &Space, slice: &Slice) -> Option<Diagnostic> {
    let warning = || {
        let message = "this entry of `only` selects no valid permutation";
        let warning =
            Diagnostic::warning(codes::EMPTY_SLICE, message).at(slice.span, "selects nothing");
        warning.note("an axis that an entry does not name is at its default")
    };
    (!space.meets(slice)).then(warning)
}
