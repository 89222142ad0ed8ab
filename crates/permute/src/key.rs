//! Points of a space, and their names.

use std::fmt;

use super::Setting;
use super::axis::{Axis, AxisKind, Mode, ValueSet};
use super::quoted::Quoted;
use super::space::{ConstraintFormula, Space};
use lamplight_bundle::key::{self, KeyPart, KeyWord};
use lamplight_diagnostic::source::Span;
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};

/// A value for every axis of a space, as ordinals in the order of its axes. Comparing two gives the
/// canonical order of permutations.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Assignment(pub(super) Box<[u8]>);

impl Assignment {
    /// The ordinal of the axis's value.
    pub fn ordinal(&self, axis: usize) -> usize {
        self.0[axis].into()
    }

    /// The ordinals, by axis.
    pub fn ordinals(&self) -> &[u8] {
        &self.0
    }

    pub(super) fn formula(&self) -> ConstraintFormula {
        let atom = |(axis, ordinal): (usize, &u8)| {
            ConstraintFormula::Is(axis, ValueSet::single((*ordinal).into()))
        };
        ConstraintFormula::All(self.0.iter().enumerate().map(atom).collect())
    }
}

/// The name of a point: what differs from the defaults, axes by name, `shadow=hard,two_sided`.
/// A boolean that is true is its name alone. Adding an axis or a value changes no name.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Key(String);

impl Key {
    pub(super) fn of(axes: &[Axis], point: &Assignment) -> Self {
        let differing: Vec<(&str, String)> = axes
            .iter()
            .zip(&point.0)
            .filter(|(axis, ordinal)| axis.default != usize::from(**ordinal))
            .map(|(axis, ordinal)| (&*axis.name, axis.values[usize::from(*ordinal)].to_string()))
            .collect();
        Self(key::write(differing.iter().map(|(axis, value)| (*axis, value.as_str()))))
    }

    /// The text.
    pub fn as_str(&self) -> &str {
        &self.0
    }
}

impl fmt::Display for Key {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

/// The point that a key names, canonical or not: parts in any order, defaults spelt out, blanks
/// around words. Whether the point is valid is another question.
pub fn parse(space: &Space, key: &Quoted) -> Result<Assignment, Diagnostics> {
    parse_over(space, space.default_assignment(), key)
}

/// The point that a key names, where the axes that it leaves out have their values from another
/// point.
pub fn parse_over(
    space: &Space,
    mut point: Assignment,
    key: &Quoted,
) -> Result<Assignment, Diagnostics> {
    let mut seen: Vec<Option<Span>> = vec![None; space.axes().len()];
    let mut problems = Vec::new();
    for part in key::parts(&key.text) {
        match named_choice(space, key, part) {
            Ok((axis, ordinal, span)) => {
                problems.extend(seen[axis].map(|first| named_twice(space, axis, span, first)));
                seen[axis] = Some(span);
                point.0[axis] = ordinal as u8;
            }
            Err(problem) => problems.push(problem),
        }
    }
    if problems.is_empty() { Ok(point) } else { Err(problems) }
}

fn named_choice(
    space: &Space,
    key: &Quoted,
    part: KeyPart<'_>,
) -> Result<(usize, usize, Span), Diagnostic> {
    let place = |word: KeyWord<'_>| key.span(word.start..word.start + word.text.len());
    let last = part.value.unwrap_or(part.axis);
    let span = key.span(part.axis.start..last.start + last.text.len());
    if part.axis.text.is_empty() {
        return Err(Diagnostic::error(
            codes::KEY_SYNTAX,
            "expected `axis=value` or the name of a boolean axis",
        )
        .at(span, "no axis here"));
    }
    let axis = find_axis(space.axes(), part.axis.text, place(part.axis))?;
    let found = &space.axes()[axis];
    let ordinal = match part.value {
        None if found.kind == AxisKind::Bool => find_value(found, &Setting::Bool(true), span)?,
        Some(value) if !value.text.is_empty() => {
            find_value(found, &Setting::parse(value.text), place(value))?
        }
        None | Some(_) => return Err(valueless_part(found, span)),
    };
    Ok((axis, ordinal, span))
}

/// The index of an axis, by its name. Dynamic axes are refused, since permutations do not differ in
/// them.
pub(super) fn find_axis(axes: &[Axis], name: &str, span: Span) -> Result<usize, Diagnostic> {
    match axes.iter().position(|axis| axis.name == name) {
        Some(index) if axes[index].mode == Mode::Dynamic => Err(dynamic_axis(&axes[index], span)),
        Some(index) => Ok(index),
        None => {
            let unknown =
                Diagnostic::error(codes::UNKNOWN_AXIS, format!("there is no axis `{name}`"))
                    .at(span, "not declared");
            Err(unknown.suggest(name, axes.iter().map(|axis| axis.name.as_str())))
        }
    }
}

/// The ordinal of a value.
pub(super) fn find_value(axis: &Axis, value: &Setting, span: Span) -> Result<usize, Diagnostic> {
    axis.ordinal(value).ok_or_else(|| {
        let (names, text) = (axis.value_names(), value.to_string());
        let unknown = Diagnostic::error(
            codes::UNKNOWN_VALUE,
            format!("axis `{}` has no value `{text}`", axis.name),
        );
        let unknown = unknown.at(span, "not one of its values");
        let unknown = match axis.kind {
            _ if names.contains(&text) => unknown.note(format!(
                "help: the axis is {}; write the value without quotes",
                axis.kind.name()
            )),
            AxisKind::Enum => unknown.suggest(&text, names.iter().map(String::as_str)),
            AxisKind::Bool | AxisKind::Int => unknown,
        };
        unknown.note(format!("values of `{}`: {}", axis.name, names.join(", ")))
    })
}

fn dynamic_axis(axis: &Axis, span: Span) -> Diagnostic {
    Diagnostic::error(
        codes::DYNAMIC_AXIS,
        format!("axis `{}` is dynamic: its value is chosen while running", axis.name),
    )
    .at(span, "permutations do not differ in it")
    .at(axis.span, "declared here")
}

fn valueless_part(axis: &Axis, span: Span) -> Diagnostic {
    let message = format!("{} axis `{}` needs a value", axis.kind.name(), axis.name);
    let note = format!("write `{}=` and one of: {}", axis.name, axis.value_names().join(", "));
    Diagnostic::error(codes::KEY_SYNTAX, message).at(span, "no value here").note(note)
}

fn named_twice(space: &Space, axis: usize, span: Span, first: Span) -> Diagnostic {
    Diagnostic::error(codes::KEY_SYNTAX, format!("axis `{}` is set twice", space.axes()[axis].name))
        .at(span, "set again here")
        .at(first, "first set here")
}
