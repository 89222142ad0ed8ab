//! The lists `include`, `only` and `exclude` of a program.

use super::reader::{ManifestReader, TomlName, TomlValue};
use crate::axis::{Axis, ValueSet};
use crate::key::{Assignment, find_axis, find_value, parse};
use crate::quoted::Quoted;
use crate::space::{Slice, Space};
use lamplight_diagnostic::{Diagnostic, codes};

/// Every value of an axis, in an entry of `only`.
const ANY: &str = "*";

/// Reads slices in which an axis that is not named has its default.
pub fn read_only(reader: &mut ManifestReader, axes: &[Axis], value: &TomlValue) -> Vec<Slice> {
    let unnamed: Vec<ValueSet> = axes.iter().map(|axis| ValueSet::single(axis.default)).collect();
    read_slices(reader, axes, value, "only", &unnamed)
}

/// Reads slices in which an axis that is not named has any value.
pub fn read_exclude(reader: &mut ManifestReader, axes: &[Axis], value: &TomlValue) -> Vec<Slice> {
    let unnamed: Vec<ValueSet> =
        axes.iter().map(|axis| ValueSet::full(axis.values.len())).collect();
    read_slices(reader, axes, value, "exclude", &unnamed)
}

/// The points that keys name; `space` has the constraints, and each must satisfy them.
pub fn read_include(
    reader: &mut ManifestReader,
    space: &Space,
    value: &TomlValue,
) -> Vec<Assignment> {
    let Some(array) = reader.array(value, "`include`") else { return Vec::new() };
    array.iter().filter_map(|value| included_point(reader, space, value)).collect()
}

fn included_point(
    reader: &mut ManifestReader,
    space: &Space,
    value: &TomlValue,
) -> Option<Assignment> {
    let key = reader.string(value, "an entry of `include`")?;
    let point = parse(space, &key).map_err(|problems| reader.problems.extend(problems)).ok()?;
    let broken: Vec<Diagnostic> = space
        .broken(&point)
        .map(|constraint| invalid_key(&key, &constraint.text, constraint.span))
        .collect();
    reader.problems.extend(broken);
    Some(point)
}

fn invalid_key(
    key: &Quoted,
    constraint: &str,
    span: lamplight_diagnostic::source::Span,
) -> Diagnostic {
    Diagnostic::error(
        codes::INVALID_PERMUTATION,
        format!("permutation `{}` breaks the constraint `{constraint}`", key.text),
    )
    .at(key.span, "included here")
    .at(span, "breaks this constraint")
}

fn read_slices(
    reader: &mut ManifestReader,
    axes: &[Axis],
    value: &TomlValue,
    list: &str,
    unnamed: &[ValueSet],
) -> Vec<Slice> {
    let Some(array) = reader.array(value, &format!("`{list}`")) else { return Vec::new() };
    array.iter().filter_map(|value| read_slice(reader, axes, value, list, unnamed)).collect()
}

fn read_slice(
    reader: &mut ManifestReader,
    axes: &[Axis],
    value: &TomlValue,
    list: &str,
    unnamed: &[ValueSet],
) -> Option<Slice> {
    let table = reader.table(value, &format!("an entry of `{list}`"))?;
    let mut values = unnamed.to_vec();
    for (name, value) in table.iter() {
        if let Some((axis, set)) = named_values(reader, axes, name, value) {
            values[axis] = set;
        }
    }
    Some(Slice { values, span: reader.span(value.span()) })
}

/// An axis of a slice and the values that it may have.
fn named_values(
    reader: &mut ManifestReader,
    axes: &[Axis],
    name: &TomlName,
    value: &TomlValue,
) -> Option<(usize, ValueSet)> {
    let span = reader.span(name.span());
    let axis = find_axis(axes, name.get_ref(), span)
        .map_err(|problem| reader.problems.push(problem))
        .ok()?;
    let found = &axes[axis];
    let set = match value.get_ref().as_array() {
        _ if value.get_ref().as_str() == Some(ANY) => ValueSet::full(found.values.len()),
        Some(values) => {
            values.iter().filter_map(|value| value_index(reader, found, value)).collect()
        }
        None => ValueSet::single(value_index(reader, found, value)?),
    };
    Some((axis, set))
}

fn value_index(reader: &mut ManifestReader, axis: &Axis, value: &TomlValue) -> Option<usize> {
    let setting = reader.setting(value, &format!("a value of `{}`", axis.name))?;
    let span = reader.span(value.span());
    find_value(axis, &setting, span).map_err(|problem| reader.problems.push(problem)).ok()
}
