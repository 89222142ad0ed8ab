//! Keys for TypeScript: types that can be erased, so that it is enough if a runtime strips them.

use std::fmt::Write;

use super::names::{Taken, camel_case, comment_lines, lower_camel};
use super::ordinal::{Ordinals, Says, key_ordinals};
use super::{KeyLanguage, default_setting, key_axes};
use lamplight_bundle::key::{ASSIGNS, DEFAULT, SEPARATOR};
use lamplight_permute::{Axis, AxisKind, Lock, Manifest, Program, Setting};

pub const LANGUAGE: KeyLanguage =
    KeyLanguage { name: "ts", about: "a TypeScript module of erasable types", write };

/// Members of every object. A field with such a name would not be undefined where it is left out.
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
  const parts = differing.map(([axis]) => (chosen[axis] === true ? axis : `${axis}ASSIGNS${chosen[axis]}`));
  return parts.join(\"SEPARATOR\") || \"DEFAULT\";
}
";

/// The functions that convert keys to numbers and back. `numberKey` returns undefined if a digit of
/// the number stands for a value that no longer exists.
const NUMBERS: &str = "
/** A field with its default, and what each of its values adds to a number. */
type Field = readonly [string, Value, readonly (readonly [Value, number])[]];

/** A digit of a number: its weight, its radix, its field and the value that each of its values sets. */
type Digit = readonly [number, number, string, readonly (Value | null | undefined)[]];

function keyNumber(key: object, start: number, fields: readonly Field[]): number {
  const chosen = key as Record<string, Value | undefined>;
  const added = fields.map(([field, value, adds]) => adds.find(([known]) => known === (chosen[field] ?? value))?.[1]);
  return added.reduce<number>((sum, add) => sum + (add ?? 0), start);
}

/** The fields that a number sets; null leaves one as it is, undefined is a value that is gone. */
function numberKey(number: number, digits: readonly Digit[]): Record<string, Value> | undefined {
  const key: Record<string, Value> = {};
  for (const [weight, radix, field, values] of digits) {
    const value = values[Math.floor(number / weight) % radix];
    if (value === undefined) return undefined;
    if (value !== null) key[field] = value;
  }
  return key;
}
";

/// As [`NUMBERS`], for numbers that only a `bigint` can hold.
const BIG_NUMBERS: &str = "
type BigField = readonly [string, Value, readonly (readonly [Value, bigint])[]];

type BigDigit = readonly [bigint, bigint, string, readonly (Value | null | undefined)[]];

function keyBigNumber(key: object, start: bigint, fields: readonly BigField[]): bigint {
  const chosen = key as Record<string, Value | undefined>;
  const added = fields.map(([field, value, adds]) => adds.find(([known]) => known === (chosen[field] ?? value))?.[1]);
  return added.reduce<bigint>((sum, add) => sum + (add ?? 0n), start);
}

function bigNumberKey(number: bigint, digits: readonly BigDigit[]): Record<string, Value> | undefined {
  const key: Record<string, Value> = {};
  for (const [weight, radix, field, values] of digits) {
    const value = values[Number((number / weight) % radix)];
    if (value === undefined) return undefined;
    if (value !== null) key[field] = value;
  }
  return key;
}
";

/// Integers below this are exact as a number of the language.
const EXACT: u128 = 1 << 53;

/// How numbers of keys are written: their type, the end of their literals, and the functions.
struct NumberForm {
    ty: &'static str,
    end: &'static str,
    to: &'static str,
    from: &'static str,
}

const SMALL: NumberForm = NumberForm { ty: "number", end: "", to: "keyNumber", from: "numberKey" };
const BIG: NumberForm =
    NumberForm { ty: "bigint", end: "n", to: "keyBigNumber", from: "bigNumberKey" };

fn write(manifest: &Manifest, lock: Option<&Lock>) -> String {
    let mut taken = Taken::new(&["Value", "keyText", "Record", "Math"]);
    let mut text = START
        .replace("ASSIGNS", &ASSIGNS.to_string())
        .replace("SEPARATOR", &SEPARATOR.to_string())
        .replace("\"DEFAULT\"", &format!("\"{DEFAULT}\""));
    let found: Vec<Option<Ordinals>> = manifest
        .programs
        .iter()
        .map(|program| lock.and_then(|lock| key_ordinals(program, lock, u64::MAX)))
        .collect();
    let has_big = found.iter().flatten().any(|ordinals| ordinals.range > EXACT);
    let has_small = found.iter().flatten().any(|ordinals| ordinals.range <= EXACT);
    let helpers: [(bool, &[&str], &str); 2] = [
        (has_small, &["Field", "Digit", "keyNumber", "numberKey"], NUMBERS),
        (has_big, &["BigField", "BigDigit", "keyBigNumber", "bigNumberKey"], BIG_NUMBERS),
    ];
    for (_, names, helper) in helpers.iter().filter(|(is_used, ..)| *is_used) {
        for name in *names {
            taken.give((*name).to_owned());
        }
        text.push_str(helper);
    }
    for (program, ordinals) in manifest.programs.iter().zip(&found) {
        text.push_str(&self::program_keys(program, ordinals.as_ref(), &mut taken));
    }
    text
}

fn program_keys(program: &Program, ordinals: Option<&Ordinals>, taken: &mut Taken) -> String {
    let ty = taken.give(format!("{}Key", camel_case(&program.name)));
    let function = taken.give(format!("{}Key", lower_camel(&program.name)));
    let mut text = format!(
        "\n/** One permutation of program `{}`; what is left out is at its default. */\nexport interface {ty} {{\n",
        program.name
    );
    let mut fields = Taken::new(INHERITED);
    let fields: Vec<String> =
        key_axes(program).map(|axis| fields.give(axis.name.clone())).collect();
    for (axis, field) in key_axes(program).zip(&fields) {
        text.push_str(
            &axis.doc.as_deref().map_or(String::new(), |doc| {
                format!("  /**\n{}   */\n", comment_lines("   *", doc))
            }),
        );
        let _ = writeln!(text, "  {field}?: {};", value_union(axis));
    }
    text.push_str("}\n");
    let defaults: Vec<String> = key_axes(program)
        .map(|axis| format!("  [\"{}\", {}],\n", axis.name, value_literal(default_setting(axis))))
        .collect();
    let list = if defaults.is_empty() { String::new() } else { format!("\n{}", defaults.concat()) };
    let _ = writeln!(
        text,
        "\n/** The canonical key, as a bundle's loader takes it. */\nexport function {function}(key: {ty} = {{}}): string {{"
    );
    let _ = writeln!(
        text,
        "  return keyText({}, [{}]);\n}}",
        renamed_fields(program, &fields),
        list.replace("\n  ", "\n    ").trim_end_matches(' ').to_owned()
            + if list.is_empty() { "" } else { "  " }
    );
    if let Some(ordinals) = ordinals {
        let lower = lower_camel(&program.name);
        let names = ["Ordinal", "FromOrdinal"].map(|what| taken.give(format!("{lower}{what}")));
        text.push_str(&number_functions(program, ordinals, &ty, (&fields, &names)));
    }
    text
}

/// The functions from a key to its number, and back.
fn number_functions(
    program: &Program,
    ordinals: &Ordinals,
    ty: &str,
    (fields, [to, from]): (&[String], &[String; 2]),
) -> String {
    let axes: Vec<&Axis> = key_axes(program).collect();
    let NumberForm { ty: number, end, to: to_number, from: to_key } =
        if ordinals.range > EXACT { BIG } else { SMALL };
    let field = |((axis, field), adds): ((&&Axis, &String), &Vec<u64>)| {
        let adds = axis.values.iter().zip(adds);
        let adds: Vec<String> =
            adds.map(|(value, add)| format!("[{}, {add}{end}]", value_literal(value))).collect();
        format!(
            "    [\"{field}\", {}, [{}]],\n",
            value_literal(default_setting(axis)),
            adds.join(", ")
        )
    };
    let listed: String = axes.iter().zip(fields).zip(&ordinals.of_values).map(field).collect();
    let mut text = format!(
        "\n/** The number in the lock file: it stays what it is when axes and values are added. */\nexport function {to}(key: {ty} = {{}}): {number} {{\n  return {to_number}(key, {}{end}, [\n{listed}  ]);\n}}\n",
        ordinals.constant
    );
    let digit = |digit: &super::ordinal::KeyDigit| {
        let says = digit.says.iter().map(|says| match says {
            Says::Value(value) => value_literal(&axes[digit.axis].values[*value]),
            Says::Nothing => "null".to_owned(),
            Says::Gone => "undefined".to_owned(),
        });
        let says = says.collect::<Vec<_>>().join(", ");
        let (weight, radix, field) = (digit.weight, digit.radix, &fields[digit.axis]);
        format!("    [{weight}{end}, {radix}{end}, \"{field}\", [{says}]],\n")
    };
    let digits: String = ordinals.digits.iter().map(digit).collect();
    let _ = write!(
        text,
        "\n/** The key of a number; undefined if there is none. */\nexport function {from}(number: {number}): {ty} | undefined {{\n  const key: {ty} | undefined = {to_key}(number, [\n{digits}  ]);\n  return key !== undefined && {to}(key) === number ? key : undefined;\n}}\n"
    );
    text
}

/// The key, with the names of axes instead of fields that have other names.
fn renamed_fields(program: &Program, fields: &[String]) -> String {
    let differing = key_axes(program).zip(fields).filter(|(axis, field)| axis.name != **field);
    let names: Vec<String> = differing
        .map(|(axis, field)| {
            format!("{}: key.{field} ?? {}", axis.name, value_literal(default_setting(axis)))
        })
        .collect();
    match names.is_empty() {
        true => "key".to_owned(),
        false => format!("{{ ...key, {} }}", names.join(", ")),
    }
}

fn value_union(axis: &Axis) -> String {
    match axis.kind {
        AxisKind::Bool => "boolean".to_owned(),
        AxisKind::Enum | AxisKind::Int => {
            axis.values.iter().map(value_literal).collect::<Vec<_>>().join(" | ")
        }
    }
}

/// A value as a literal. Integers that a `number` cannot hold are of type `bigint`.
fn value_literal(value: &Setting) -> String {
    match value {
        Setting::Name(name) => format!("\"{name}\""),
        Setting::Int(number) if number.unsigned_abs() >= 1 << 53 => format!("{number}n"),
        other => other.to_string(),
    }
}
