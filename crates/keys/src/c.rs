//! Keys for C and C++: one header of inline functions.

use std::fmt::Write;

use super::names::{Taken, comment_lines, value_name};
use super::ordinal::{Ordinals, Says, key_ordinals};
use super::{KeyLanguage, default_setting, key_axes, key_part};
use lamplight_bundle::key::{DEFAULT, SEPARATOR};
use lamplight_permute::{Axis, AxisKind, Lock, Manifest, Program, Setting};

pub const LANGUAGE: KeyLanguage =
    KeyLanguage { name: "c", about: "a header for C99 and C++", write };

/// Keywords of both languages that are valid names of axes.
#[rustfmt::skip]
pub const KEYWORDS: &[&str] = &[
    "alignas", "alignof", "and", "and_eq", "asm", "auto", "bitand", "bitor", "bool", "break",
    "case", "catch", "char", "char16_t", "char32_t", "char8_t", "class", "co_await", "co_return",
    "co_yield", "compl", "concept", "const", "const_cast", "consteval", "constexpr", "constinit",
    "continue", "decltype", "default", "delete", "do", "double", "dynamic_cast", "else", "enum",
    "explicit", "export", "extern", "false", "float", "for", "friend", "goto", "if", "inline",
    "int", "long", "mutable", "namespace", "new", "noexcept", "not", "not_eq", "nullptr",
    "operator", "or", "or_eq", "private", "protected", "public", "register", "reinterpret_cast",
    "requires", "restrict", "return", "short", "signed", "sizeof", "static", "static_assert",
    "static_cast", "struct", "switch", "template", "this", "thread_local", "throw", "true", "try",
    "typedef", "typeid", "typename", "union", "unsigned", "using", "virtual", "void", "volatile",
    "wchar_t", "while", "xor", "xor_eq",
];

const START: &str = "/* Written by `lamplight keys --lang c`; do not edit. */
#ifndef GUARD
#define GUARD

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* What all headers of keys share, so that several can be included. */
#ifndef LAMPLIGHT_KEY_PART
#define LAMPLIGHT_KEY_PART
/* Appends a part of a key; the length of the text. */
static inline size_t lamplight_key_part(char *text, size_t length, const char *part)
{
    size_t added = strlen(part);
    if (length > 0)
        text[length++] = 'SEPARATOR';
    memcpy(text + length, part, added + 1);
    return length + added;
}
#endif
";

fn write(manifest: &Manifest, lock: Option<&Lock>) -> String {
    let guard = include_guard(manifest);
    let mut taken = Taken::new(&[&guard, "LAMPLIGHT_KEY_PART", "lamplight_key_part"]);
    let mut text = START.replace("GUARD", &guard).replace("SEPARATOR", &SEPARATOR.to_string());
    for program in &manifest.programs {
        let found = lock.and_then(|lock| key_ordinals(program, lock, u64::MAX));
        text.push_str(&self::program_keys(program, found.as_ref(), &mut taken));
    }
    text.push_str("\n#endif\n");
    text
}

/// An include guard of its own for each manifest, from a hash of its programs' names.
fn include_guard(manifest: &Manifest) -> String {
    let names: Vec<&str> = manifest.programs.iter().map(|program| program.name.as_str()).collect();
    let hash = blake3::hash(names.join("\n").as_bytes()).to_hex();
    format!("LAMPLIGHT_KEYS_{}_H", hash[..16].to_uppercase())
}

/// An axis with its identifiers.
struct CAxis<'a> {
    axis: &'a Axis,
    field: String,
    ty: String,
    constants: Vec<String>,
}

impl CAxis<'_> {
    fn default(&self) -> &str {
        match (self.axis.kind, self.axis.default) {
            (AxisKind::Bool, _) if *default_setting(self.axis) == Setting::Bool(true) => "true",
            (AxisKind::Bool, _) => "false",
            (_, ordinal) => &self.constants[ordinal],
        }
    }

    /// The value of that index, as an expression.
    fn value(&self, index: usize) -> String {
        match self.axis.kind {
            AxisKind::Bool => self.axis.values[index].to_string(),
            AxisKind::Enum | AxisKind::Int => self.constants[index].clone(),
        }
    }
}

fn program_keys(program: &Program, ordinals: Option<&Ordinals>, taken: &mut Taken) -> String {
    let name = taken.give(format!("lamplight_{}", program.name));
    let [default, to_key, bytes] = [
        format!("{name}_default"),
        format!("{name}_to_key"),
        format!("{}_KEY_BYTES", name.to_uppercase()),
    ]
    .map(|name| taken.give(name));
    let mut fields = Taken::new(KEYWORDS);
    let axes: Vec<CAxis<'_>> =
        key_axes(program).map(|axis| named_axis(axis, &name, taken, &mut fields)).collect();
    let mut text = String::from("\n");
    axes.iter()
        .filter(|axis| axis.axis.kind != AxisKind::Bool)
        .for_each(|axis| text.push_str(&write_enumeration(axis)));
    text.push_str(&write_structure(program, &name, &axes));
    let _ = writeln!(
        text,
        "\n/* Bytes of the longest key, its end included. */\n#define {bytes} {}",
        longest_key(&axes)
    );
    let _ = writeln!(text, "\nstatic inline {name} {default}(void)\n{{\n    {name} key;");
    text.extend(axes.iter().map(|axis| format!("    key.{} = {};\n", axis.field, axis.default())));
    if axes.is_empty() {
        text.push_str("    key.none = 0;\n");
    }
    text.push_str("    return key;\n}\n");
    text.push_str(&to_text(&name, &to_key, &bytes, &axes));
    if let Some(ordinals) = ordinals {
        let names = ["to_ordinal", "from_ordinal"].map(|what| taken.give(format!("{name}_{what}")));
        text.push_str(&to_ordinal(&name, &names[0], &axes, ordinals));
        text.push_str(&from_ordinal(&name, (&names, &default), &axes, ordinals));
    }
    text
}

fn named_axis<'a>(
    axis: &'a Axis,
    program: &str,
    taken: &mut Taken,
    fields: &mut Taken,
) -> CAxis<'a> {
    let ty = match axis.kind {
        AxisKind::Bool => "bool".to_owned(),
        AxisKind::Enum | AxisKind::Int => taken.give(format!("{program}_{}", axis.name)),
    };
    let prefix = format!("{program}_{}", axis.name).to_uppercase();
    let constants = match axis.kind {
        AxisKind::Bool => Vec::new(),
        AxisKind::Enum | AxisKind::Int => axis
            .values
            .iter()
            .map(|known| taken.give(format!("{prefix}_{}", value_name(known).to_uppercase())))
            .collect(),
    };
    CAxis { axis, field: fields.give(axis.name.clone()), ty, constants }
}

fn write_enumeration(CAxis { axis, ty, constants, .. }: &CAxis<'_>) -> String {
    let mut text = axis
        .doc
        .as_deref()
        .map_or(String::new(), |doc| format!("/*\n{} */\n", comment_lines(" *", doc)));
    let _ = writeln!(text, "typedef enum {ty} {{");
    text.extend(constants.iter().map(|constant| format!("    {constant},\n")));
    let _ = writeln!(text, "}} {ty};\n");
    text.replace(",\n}", "\n}")
}

fn write_structure(program: &Program, name: &str, axes: &[CAxis<'_>]) -> String {
    let mut text = format!(
        "/* One permutation of program `{}`: start from its default. */\ntypedef struct {name} {{\n",
        program.name
    );
    text.extend(axes.iter().map(|axis| format!("    {} {};\n", axis.ty, axis.field)));
    if axes.is_empty() {
        text.push_str(
            "    /* There is one permutation; C has no empty structures. */\n    char none;\n",
        );
    }
    let _ = writeln!(text, "}} {name};");
    text
}

fn longest_key(axes: &[CAxis<'_>]) -> usize {
    let parts = axes.iter().map(|named| {
        named
            .axis
            .values
            .iter()
            .map(|value| key_part(named.axis, value).len() + 1)
            .max()
            .unwrap_or(0)
    });
    parts.sum::<usize>().max(DEFAULT.len() + 1)
}

fn to_text(name: &str, to_key: &str, bytes: &str, axes: &[CAxis<'_>]) -> String {
    let mut text = format!(
        "\n/* Writes the canonical key into {bytes} bytes; its length. A value that the axis does not have counts as the default. */\n"
    );
    let _ = writeln!(
        text,
        "static inline size_t {to_key}(const {name} *key, char *text)\n{{\n    size_t length = 0;"
    );
    if axes.is_empty() {
        text.push_str("    (void)key;\n");
    }
    axes.iter().for_each(|axis| text.push_str(&append_part(axis)));
    let _ = writeln!(
        text,
        "    return length > 0 ? length : lamplight_key_part(text, 0, \"{DEFAULT}\");\n}}"
    );
    text
}

fn append_part(named: &CAxis<'_>) -> String {
    let CAxis { axis, field, .. } = named;
    if axis.kind == AxisKind::Bool {
        let other = axis.values.iter().find(|value| *value != default_setting(axis));
        let append = |value| {
            format!(
                "    if (key->{field} != {})\n        length = lamplight_key_part(text, length, \"{}\");\n",
                named.default(),
                key_part(axis, value)
            )
        };
        return other.map_or(String::new(), append);
    }
    let parts: Vec<String> =
        axis.values.iter().map(|value| format!("\"{}\"", key_part(axis, value))).collect();
    let mut text =
        format!("    {{\n        static const char *const parts[] = {{{}}};\n", parts.join(", "));
    let _ = writeln!(
        text,
        "        if (key->{field} != {} && (size_t)key->{field} < sizeof parts / sizeof *parts)",
        named.default()
    );
    let _ = writeln!(
        text,
        "            length = lamplight_key_part(text, length, parts[key->{field}]);\n    }}"
    );
    text
}

/// The function from a key to its number.
fn to_ordinal(name: &str, function: &str, axes: &[CAxis<'_>], ordinals: &Ordinals) -> String {
    let mut text = String::from(
        "\n/* The number in the lock file: it stays what it is when axes and values are added. A value that the axis does not have counts as the default. */\n",
    );
    let _ = writeln!(text, "static inline uint64_t {function}(const {name} *key)\n{{");
    let _ = writeln!(text, "    uint64_t number = UINT64_C({});", ordinals.constant);
    if axes.is_empty() {
        text.push_str("    (void)key;\n");
    }
    for (named, adds) in axes.iter().zip(&ordinals.of_values) {
        let (adds, place) = added_numbers(named, adds);
        let adds: Vec<String> = adds.iter().map(|add| format!("UINT64_C({add})")).collect();
        let _ = writeln!(
            text,
            "    {{\n        static const uint64_t adds[] = {{{}}};",
            adds.join(", ")
        );
        let _ = writeln!(text, "        number += adds[{place}];\n    }}");
    }
    text + "    return number;\n}\n"
}

/// The numbers that the values of an axis add, and the expression for the index of the one that a
/// key adds.
fn added_numbers(named: &CAxis<'_>, adds: &[u64]) -> (Vec<u64>, String) {
    let field = &named.field;
    match named.axis.kind {
        // The manifest may list its values in either order.
        AxisKind::Bool => {
            let of = |value| named.axis.ordinal(&Setting::Bool(value)).map_or(0, |at| adds[at]);
            (vec![of(false), of(true)], format!("key->{field} ? 1 : 0"))
        }
        AxisKind::Enum | AxisKind::Int => {
            let place = format!(
                "(size_t)key->{field} < sizeof adds / sizeof *adds ? (size_t)key->{field} : (size_t){}",
                named.default()
            );
            (adds.to_vec(), place)
        }
    }
}

/// The function from a number to its key.
fn from_ordinal(
    name: &str,
    ([to_ordinal, function], default): (&[String; 2], &str),
    axes: &[CAxis<'_>],
    ordinals: &Ordinals,
) -> String {
    let mut text = String::from("\n/* Gives the key of a number; false if there is none. */\n");
    let _ = writeln!(
        text,
        "static inline bool {function}(uint64_t number, {name} *key)\n{{\n    *key = {default}();"
    );
    for digit in &ordinals.digits {
        let named = &axes[digit.axis];
        let (weight, radix) = (digit.weight, digit.radix);
        let _ = writeln!(text, "    switch (number / UINT64_C({weight}) % UINT64_C({radix})) {{");
        for (number, says) in digit.says.iter().enumerate() {
            let then = match says {
                Says::Value(value) => format!("key->{} = {};", named.field, named.value(*value)),
                Says::Nothing => String::new(),
                Says::Gone => continue,
            };
            let _ = writeln!(text, "    case {number}: {then} break;");
        }
        text.push_str("    default: return false;\n    }\n");
    }
    text + &format!("    return {to_ordinal}(key) == number;\n}}\n")
}
