//! The tables `axis` and `constraint` of a program.

use super::names;
use super::reader::{ManifestReader, TomlName, TomlValue};
use crate::Setting;
use crate::axis::{Axis, AxisKind, MAX, Mode};
use crate::constraint;
use crate::key::find_value;
use crate::space::Constraint;
use lamplight_diagnostic::source::Span;
use lamplight_diagnostic::{Diagnostic, codes};
use lamplight_files::limits::CONSTRAINTS;

const AXIS_KEYS: &[&str] = &["values", "default", "mode", "doc"];
const CONSTRAINT_KEYS: &[&str] = &["require", "doc"];

/// The axes, by name; `None` if one of them could not be read.
pub fn read_axes(reader: &mut ManifestReader, value: &TomlValue) -> Option<Vec<Axis>> {
    let table = reader.table(value, "`axis`")?;
    if table.len() > MAX {
        let message = format!("a program may have {MAX} axes, and this one has {}", table.len());
        reader.problems.push(
            Diagnostic::error(codes::AXIS_LIMIT, message)
                .at(reader.span(value.span()), "too many axes"),
        );
        return None;
    }
    let axes: Vec<Axis> =
        table.iter().filter_map(|(name, value)| read_axis(reader, name, value)).collect();
    reader.problems.extend(names::macro_collisions(&axes));
    (axes.len() == table.len()).then_some(axes)
}

/// The constraints over the axes, in the order declared.
pub fn read_constraints(
    reader: &mut ManifestReader,
    axes: &[Axis],
    value: &TomlValue,
) -> Vec<Constraint> {
    let Some(array) = reader.array(value, "`constraint`") else { return Vec::new() };
    if array.len() > CONSTRAINTS {
        let message = format!("a program may have {CONSTRAINTS} constraints, not {}", array.len());
        let last = array.last().map_or(0..0, |last| last.span());
        reader.problems.push(
            Diagnostic::error(codes::SPACE_TOO_COMPLEX, message)
                .at(reader.span(last), "the last of them"),
        );
        return Vec::new();
    }
    array.iter().filter_map(|value| read_constraint(reader, axes, value)).collect()
}

fn read_axis(reader: &mut ManifestReader, name: &TomlName, value: &TomlValue) -> Option<Axis> {
    let span = reader.span(name.span());
    let name = name.get_ref().to_string();
    let what = format!("axis `{name}`");
    reader.problems.extend(names::check_axis(&name, span));
    let table = reader.axis_table(value, &what)?;
    reader.check_keys(table, AXIS_KEYS, &what);
    let mode = table.get("mode").map_or(Some(Mode::Static), |value| read_mode(reader, value));
    let doc = reader.doc(table);
    let list = reader.required(table, "values", &what, span)?;
    let values = read_values(reader, &what, list)?;
    let kind = AxisKind::of(values.first()?);
    let mut axis = Axis { name, kind, values, default: 0, mode: mode?, doc, span };
    if let Some(value) = table.get("default") {
        axis.default = read_default(reader, &axis, value)?;
    }
    Some(axis)
}

fn read_default(reader: &mut ManifestReader, axis: &Axis, value: &TomlValue) -> Option<usize> {
    let setting = reader.setting(value, "`default`")?;
    let span = reader.span(value.span());
    find_value(axis, &setting, span).map_err(|problem| reader.problems.push(problem)).ok()
}

fn read_mode(reader: &mut ManifestReader, value: &TomlValue) -> Option<Mode> {
    let unknown = (codes::UNKNOWN_VALUE, ["there is no mode", "not a mode", "modes"]);
    reader.choice(value, "`mode`", Mode::ALL.iter().copied(), unknown)
}

/// The values, if there is at least one and nothing is wrong with any.
fn read_values(reader: &mut ManifestReader, what: &str, list: &TomlValue) -> Option<Vec<Setting>> {
    let array = reader.array(list, "`values`")?;
    let span = reader.span(list.span());
    if array.is_empty() || array.len() > MAX {
        let message = format!("{what} has {} values, and an axis has from 1 to {MAX}", array.len());
        let label = format!("expected 1 to {MAX} values");
        reader.problems.push(Diagnostic::error(codes::AXIS_LIMIT, message).at(span, label));
        return None;
    }
    let read: Vec<(Setting, Span)> = array
        .iter()
        .filter_map(|value| Some((reader.setting(value, "a value")?, reader.span(value.span()))))
        .collect();
    let problems: Vec<Diagnostic> =
        (0..read.len()).filter_map(|index| value_problem(what, &read, index)).collect();
    let sound = problems.is_empty() && read.len() == array.len();
    reader.problems.extend(problems);
    sound.then(|| read.into_iter().map(|(value, _)| value).collect())
}

fn value_problem(what: &str, values: &[(Setting, Span)], index: usize) -> Option<Diagnostic> {
    let ((value, span), (first, first_span)) = (&values[index], &values[0]);
    let (kind, expected) = (AxisKind::of(value), AxisKind::of(first));
    if kind != expected {
        let message = format!("{what} mixes {} and {} values", expected.name(), kind.name());
        return Some(
            Diagnostic::error(codes::MIXED_VALUES, message)
                .at(*span, kind.name())
                .at(*first_span, expected.name()),
        );
    }
    if let Some((_, earlier)) = values[..index].iter().find(|(earlier, _)| earlier == value) {
        let message = format!("{what} has the value `{value}` twice");
        return Some(
            Diagnostic::error(codes::DUPLICATE_VALUE, message)
                .at(*span, "again here")
                .at(*earlier, "first here"),
        );
    }
    match value {
        Setting::Name(name) => names::check_name(name, "a value", *span),
        Setting::Bool(_) | Setting::Int(_) => None,
    }
}

fn read_constraint(
    reader: &mut ManifestReader,
    axes: &[Axis],
    value: &TomlValue,
) -> Option<Constraint> {
    let table = reader.table(value, "a constraint")?;
    reader.check_keys(table, CONSTRAINT_KEYS, "a constraint");
    let doc = reader.doc(table);
    let place = reader.span(value.span());
    let require = reader.required(table, "require", "a constraint", place)?;
    let text = reader.string(require, "`require`")?;
    match constraint::parse(axes, &text) {
        Ok(formula) => Some(Constraint { text: text.text, doc, formula, span: text.span }),
        Err(problem) => {
            reader.problems.push(problem);
            None
        }
    }
}
