//! Lints of a space: constraints that are always true or always false, and values and slices that
//! no permutation has. All of these are allowed, though few authors mean them, unless nothing is
//! left: a program without permutations is an error.

use super::axis::{Axis, ValueSet};
use super::space::{Constraint, Slice, SliceLists, Space};
use lamplight_diagnostic::source::Span;
use lamplight_diagnostic::{Diagnostic, codes};
use lamplight_files::limits::{SPACE_STEPS, Steps};

/// Problems of a space; `what` and `place` name its program. A program without permutations is an
/// error: an engine would ask for shaders that do not exist.
pub fn lint(space: &Space, what: &str, place: Span) -> Vec<Diagnostic> {
    let mut found: Vec<Diagnostic> = trivial_constraints(space);
    if space.valid_count() == 0 {
        let is_cause = |found: &Diagnostic| found.code == codes::CONSTRAINT_ALWAYS_FALSE;
        if !found.iter().any(is_cause) {
            found.push(contradiction(space, what, place));
        }
        return found;
    }
    found.extend(
        space
            .axes()
            .iter()
            .zip(space.valid_values())
            .flat_map(|(axis, valid)| never_valid(axis, valid)),
    );
    let most = SPACE_STEPS as usize / space.steps_of_meeting().max(1);
    found
        .extend(space.lists().only.iter().take(most).filter_map(|slice| empty_slice(space, slice)));
    found.extend(nothing_wanted(space, what, place));
    found
}

/// The error for a space in which the lists leave no permutation.
pub fn nothing_wanted(space: &Space, what: &str, place: Span) -> Option<Diagnostic> {
    (space.count() == 0).then(|| {
        let message = format!("the lists of {what} leave no permutation");
        let error = Diagnostic::error(codes::NO_PERMUTATION, message).at(place, "ships empty");
        let lists = space.lists();
        let listed = [(&lists.only, "only this is kept"), (&lists.exclude, "this is excluded")];
        let slices =
            listed.iter().flat_map(|(slices, label)| slices.iter().map(move |s| (s, label)));
        let elsewhere = slices.filter(|(slice, _)| slice.span != place);
        elsewhere.take(SHOWN).fold(error, |error, (slice, label)| error.at(slice.span, *label))
    })
}

/// The most entries of lists, and constraints, that an error points at.
const SHOWN: usize = 4;
/// With more constraints, those that contradict each other are not searched for: each step of the
/// search counts the space again.
const SEARCHED: usize = 12;

/// The error for constraints that no permutation satisfies together. It points at the program, and
/// at constraints all of which are needed for the contradiction.
fn contradiction(space: &Space, what: &str, place: Span) -> Diagnostic {
    let message = format!("no permutation of {what} satisfies all constraints");
    let error = Diagnostic::error(codes::NO_PERMUTATION, message).at(place, "has no permutation");
    let needed = contradicting(space);
    let label = |error: Diagnostic, constraint: &&Constraint| {
        error.at(constraint.span, "contradicts the others here")
    };
    let error = needed.iter().take(SHOWN).fold(error, label);
    match needed.len() {
        0 => error,
        count => error.note(format!("help: change one of these {count} constraints")),
    }
}

/// Constraints that contradict each other, of which none can be left out; empty where the search
/// would take too long. Leaving out one of them may not be enough, if others contradict too.
fn contradicting(space: &Space) -> Vec<&Constraint> {
    let mut kept: Vec<&Constraint> = space.constraints().iter().collect();
    if kept.len() > SEARCHED {
        return Vec::new();
    }
    let mut at = 0;
    while at < kept.len() {
        let mut without = kept.clone();
        without.remove(at);
        let constraints = without.iter().map(|constraint| (*constraint).clone()).collect();
        match Space::new(space.axes().to_vec(), constraints, SliceLists::default()) {
            Ok(rest) if rest.valid_count() == 0 => kept = without,
            _ => at += 1,
        }
    }
    kept
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
    let message = format!("the constraint `{}` is always {word}", constraint.text);
    let label = format!("{word} whatever the axes are");
    Some(match satisfying {
        0 => Diagnostic::error(code, message)
            .at(constraint.span, label)
            .note("so the program has no permutation"),
        _ => Diagnostic::warning(code, message).at(constraint.span, label),
    })
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
