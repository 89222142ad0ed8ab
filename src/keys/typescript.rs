//! Keys for TypeScript: types that erase, so that a runtime which only strips them will do.

use std::fmt::Write;

use super::names::{Taken, camel, comment, lower_camel};
use super::{Language, axes, default};
use crate::permute::{Axis, Kind, Manifest, Program, Setting};

pub const LANGUAGE: Language =
    Language { name: "ts", about: "a TypeScript module of erasable types", write };

/// What every object has: a field of that name would not be left out by leaving it out.
const INHERITED: &[&str] = &[
    "constructor",
    "hasOwnProperty",
    "isPrototypeOf",
    "propertyIsEnumerable",
    "toLocaleString",
    "toString",
    "valueOf",
];

const START: &str = "// Written by `lamplight keys --lang ts`; do not edit.

type Value = string | number | bigint | boolean;

/** The canonical key: what differs from the defaults, axes sorted. */
function keyText(key: object, axes: readonly (readonly [string, Value])[]): string {
  const chosen = key as Record<string, Value | undefined>;
  const differing = axes.filter(([axis, value]) => (chosen[axis] ?? value) !== value);
  const parts = differing.map(([axis]) => (chosen[axis] === true ? axis : `${axis}=${chosen[axis]}`));
  return parts.join(\",\") || \"default\";
}
";

fn write(manifest: &Manifest) -> String {
    let mut taken = Taken::new(&["Value", "keyText", "Record"]);
    let mut text = START.to_owned();
    manifest.programs.iter().for_each(|program| text.push_str(&self::program(program, &mut taken)));
    text
}

fn program(program: &Program, taken: &mut Taken) -> String {
    let ty = taken.give(format!("{}Key", camel(&program.name)));
    let function = taken.give(format!("{}Key", lower_camel(&program.name)));
    let mut text = format!(
        "\n/** One permutation of program `{}`; what is left out is at its default. */\nexport interface {ty} {{\n",
        program.name
    );
    let mut fields = Taken::new(INHERITED);
    let fields: Vec<String> = axes(program).map(|axis| fields.give(axis.name.clone())).collect();
    for (axis, field) in axes(program).zip(&fields) {
        text.push_str(
            &axis
                .doc
                .as_deref()
                .map_or(String::new(), |doc| format!("  /**\n{}   */\n", comment("   *", doc))),
        );
        let _ = writeln!(text, "  {field}?: {};", values(axis));
    }
    text.push_str("}\n");
    let defaults: Vec<String> = axes(program)
        .map(|axis| format!("  [\"{}\", {}],\n", axis.name, literal(default(axis))))
        .collect();
    let list = if defaults.is_empty() { String::new() } else { format!("\n{}", defaults.concat()) };
    let _ = writeln!(
        text,
        "\n/** The canonical key, as a bundle's loader takes it. */\nexport function {function}(key: {ty} = {{}}): string {{"
    );
    let _ = writeln!(
        text,
        "  return keyText({}, [{}]);\n}}",
        renamed(program, &fields),
        list.replace("\n  ", "\n    ").trim_end_matches(' ').to_owned()
            + if list.is_empty() { "" } else { "  " }
    );
    text
}

/// The key with the names of axes for fields that are called otherwise.
fn renamed(program: &Program, fields: &[String]) -> String {
    let differing = axes(program).zip(fields).filter(|(axis, field)| axis.name != **field);
    let names: Vec<String> = differing
        .map(|(axis, field)| format!("{}: key.{field} ?? {}", axis.name, literal(default(axis))))
        .collect();
    match names.is_empty() {
        true => "key".to_owned(),
        false => format!("{{ ...key, {} }}", names.join(", ")),
    }
}

fn values(axis: &Axis) -> String {
    match axis.kind {
        Kind::Bool => "boolean".to_owned(),
        Kind::Enum | Kind::Int => axis.values.iter().map(literal).collect::<Vec<_>>().join(" | "),
    }
}

/// Integers that a number cannot hold are of type `bigint`.
fn literal(value: &Setting) -> String {
    match value {
        Setting::Name(name) => format!("\"{name}\""),
        Setting::Int(number) if number.unsigned_abs() >= 1 << 53 => format!("{number}n"),
        other => other.to_string(),
    }
}
