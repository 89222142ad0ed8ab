//! The lists `include`, `only` and `exclude` of a program.

use super::reader::{Name, Reader, Value};
use crate::diagnostic::{Diagnostic, codes};
use crate::permute::axis::{Axis, ValueSet};
use crate::permute::key::{Assignment, find_axis, find_value, parse};
use crate::permute::quoted::Quoted;
use crate::permute::space::{Slice, Space};

/// Every value of an axis, in an entry of `only`.
const ANY: &str = "*";

/// Reads slices in which an axis that is not named has its default.
pub fn only(reader: &mut Reader, axes: &[Axis], value: &Value) -> Vec<Slice> {
    let unnamed: Vec<ValueSet> = axes.iter().map(|axis| ValueSet::single(axis.default)).collect();
    slices(reader, axes, value, "only", &unnamed)
}

/// Reads slices in which an axis that is not named has any value.
pub fn exclude(reader: &mut Reader, axes: &[Axis], value: &Value) -> Vec<Slice> {
    let unnamed: Vec<ValueSet> =
        axes.iter().map(|axis| ValueSet::full(axis.values.len())).collect();
    slices(reader, axes, value, "exclude", &unnamed)
}

/// The points that keys name; `space` has the constraints, and each must satisfy them.
pub fn include(reader: &mut Reader, space: &Space, value: &Value) -> Vec<Assignment> {
    let Some(array) = reader.array(value, "`include`") else { return Vec::new() };
    array.iter().filter_map(|value| included(reader, space, value)).collect()
}

fn included(reader: &mut Reader, space: &Space, value: &Value) -> Option<Assignment> {
    let key = reader.string(value, "an entry of `include`")?;
    let point = parse(space, &key).map_err(|problems| reader.problems.extend(problems)).ok()?;
    let broken: Vec<Diagnostic> = space
        .broken(&point)
        .map(|constraint| invalid(&key, &constraint.text, constraint.span))
        .collect();
    reader.problems.extend(broken);
    Some(point)
}

fn invalid(key: &Quoted, constraint: &str, span: crate::source::Span) -> Diagnostic {
    Diagnostic::error(
        codes::INVALID_PERMUTATION,
        format!("permutation `{}` breaks the constraint `{constraint}`", key.text),
    )
    .at(key.span, "included here")
    .at(span, "breaks this constraint")
}

fn slices(
    reader: &mut Reader,
    axes: &[Axis],
    value: &Value,
    list: &str,
    unnamed: &[ValueSet],
) -> Vec<Slice> {
    let Some(array) = reader.array(value, &format!("`{list}`")) else { return Vec::new() };
    array.iter().filter_map(|value| slice(reader, axes, value, list, unnamed)).collect()
}

fn slice(
    reader: &mut Reader,
    axes: &[Axis],
    value: &Value,
    list: &str,
    unnamed: &[ValueSet],
) -> Option<Slice> {
    let table = reader.table(value, &format!("an entry of `{list}`"))?;
    let mut values = unnamed.to_vec();
    for (name, value) in table.iter() {
        if let Some((axis, set)) = named(reader, axes, name, value) {
            values[axis] = set;
        }
    }
    Some(Slice { values, span: reader.span(value.span()) })
}

/// An axis of a slice and the values that it may have.
fn named(
    reader: &mut Reader,
    axes: &[Axis],
    name: &Name,
    value: &Value,
) -> Option<(usize, ValueSet)> {
    let span = reader.span(name.span());
    let axis = find_axis(axes, name.get_ref(), span)
        .map_err(|problem| reader.problems.push(problem))
        .ok()?;
    let found = &axes[axis];
    let set = match value.get_ref().as_array() {
        _ if value.get_ref().as_str() == Some(ANY) => ValueSet::full(found.values.len()),
        Some(values) => values.iter().filter_map(|value| ordinal(reader, found, value)).collect(),
        None => ValueSet::single(ordinal(reader, found, value)?),
    };
    Some((axis, set))
}

fn ordinal(reader: &mut Reader, axis: &Axis, value: &Value) -> Option<usize> {
    let setting = reader.setting(value, &format!("a value of `{}`", axis.name))?;
    let span = reader.span(value.span());
    find_value(axis, &setting, span).map_err(|problem| reader.problems.push(problem)).ok()
}
