//! Keys for Rust: one module a program, to `include!` or to keep as a file.

use std::fmt::Write;

use super::names::{Taken, camel_case, documentation_lines, value_name};
use super::ordinal::{Ordinals, Says, key_ordinals};
use super::{KeyLanguage, default_setting, key_axes, key_part};
use lamplight_bundle::key::{DEFAULT, SEPARATOR};
use lamplight_permute::{Axis, AxisKind, Lock, Manifest, Program};

pub const LANGUAGE: KeyLanguage =
    KeyLanguage { name: "rust", about: "a module a program, for any edition", write };

/// Keywords that are valid names of axes. `r#` would not work for all of them.
pub const KEYWORDS: &[&str] = &[
    "Self", "abstract", "as", "async", "await", "become", "box", "break", "const", "continue",
    "crate", "do", "dyn", "else", "enum", "extern", "false", "final", "fn", "for", "gen", "if",
    "impl", "in", "let", "loop", "macro", "match", "mod", "move", "mut", "priv", "pub", "ref",
    "return", "self", "static", "struct", "super", "trait", "true", "try", "type", "typeof",
    "unsafe", "unsized", "use", "virtual", "where", "while", "yield",
];

fn write(manifest: &Manifest, lock: Option<&Lock>) -> String {
    let mut taken = Taken::new(KEYWORDS);
    let mut text = String::from("// Written by `lamplight keys --lang rust`; do not edit.\n");
    manifest.programs.iter().for_each(|program| {
        text.push_str(&program_module(program, lock, &taken.give(program.name.clone())))
    });
    text
}

/// An axis with its identifiers.
struct RustAxis<'a> {
    axis: &'a Axis,
    field: String,
    ty: String,
    variants: Vec<String>,
}

impl RustAxis<'_> {
    fn default(&self) -> String {
        self.value(self.axis.default)
    }

    /// The value of that index, as an expression and as a pattern.
    fn value(&self, index: usize) -> String {
        match self.axis.kind {
            AxisKind::Bool => self.axis.values[index].to_string(),
            AxisKind::Enum | AxisKind::Int => format!("{}::{}", self.ty, self.variants[index]),
        }
    }
}

fn named_axes(program: &Program) -> Vec<RustAxis<'_>> {
    let (mut fields, mut types) = (Taken::new(KEYWORDS), Taken::new(&["Key", "Self"]));
    let named = key_axes(program).map(|axis| {
        let mut variants = Taken::new(KEYWORDS);
        let ty = match axis.kind {
            AxisKind::Bool => "bool".to_owned(),
            AxisKind::Enum | AxisKind::Int => types.give(camel_case(&axis.name)),
        };
        let variants =
            axis.values.iter().map(|known| variants.give(camel_case(&value_name(known)))).collect();
        RustAxis { axis, field: fields.give(axis.name.clone()), ty, variants }
    });
    named.collect()
}

fn program_module(program: &Program, lock: Option<&Lock>, name: &str) -> String {
    let axes = named_axes(program);
    let mut text = format!("\n/// Keys of program `{}`.\n", program.name);
    text.push_str(
        &program
            .doc
            .as_deref()
            .map_or(String::new(), |doc| format!("///\n{}", documentation_lines("///", doc))),
    );
    let _ =
        writeln!(text, "#[allow(dead_code, non_camel_case_types, clippy::all)]\npub mod {name} {{");
    axes.iter()
        .filter(|axis| axis.axis.kind != AxisKind::Bool)
        .for_each(|axis| text.push_str(&write_enumeration(axis)));
    text.push_str(&write_structure(&axes));
    text.push_str(&display_impl(&axes));
    let found = lock.and_then(|lock| key_ordinals(program, lock, u64::MAX));
    text.push_str(&found.map_or(String::new(), |found| number_functions(&axes, &found)));
    text.push_str("}\n");
    text
}

fn write_enumeration(RustAxis { axis, ty, variants, .. }: &RustAxis<'_>) -> String {
    let mut text =
        axis.doc.as_deref().map_or(String::new(), |doc| documentation_lines("    ///", doc));
    let _ = writeln!(
        text,
        "    #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]\n    pub enum {ty} {{"
    );
    text.extend(variants.iter().map(|variant| format!("        {variant},\n")));
    let all: Vec<String> = variants.iter().map(|variant| format!("Self::{variant}")).collect();
    let _ = writeln!(text, "    }}\n\n    impl {ty} {{");
    let _ = writeln!(text, "        /// Every value, in the manifest's order.");
    let _ = writeln!(text, "        pub const ALL: &'static [Self] = &[{}];\n", all.join(", "));
    let _ = writeln!(
        text,
        "        /// As in keys.\n        pub const fn name(self) -> &'static str {{\n            match self {{"
    );
    let arms = variants.iter().zip(&axis.values);
    text.extend(
        arms.map(|(variant, value)| format!("                Self::{variant} => \"{value}\",\n")),
    );
    text.push_str("            }\n        }\n    }\n\n");
    text
}

fn write_structure(axes: &[RustAxis<'_>]) -> String {
    let mut text =
        String::from("    /// One permutation: `Key { axis: value, ..Key::default() }`.\n");
    text.push_str("    #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]\n    pub struct Key {\n");
    for RustAxis { axis, field, ty, .. } in axes {
        let doc = axis.doc.as_deref().filter(|_| axis.kind == AxisKind::Bool);
        text.push_str(&doc.map_or(String::new(), |doc| documentation_lines("        ///", doc)));
        let _ = writeln!(text, "        pub {field}: {ty},");
    }
    text.push_str("    }\n\n    impl ::core::default::Default for Key {\n        fn default() -> Self {\n            Self {\n");
    text.extend(
        axes.iter().map(|axis| format!("                {}: {},\n", axis.field, axis.default())),
    );
    text.push_str("            }\n        }\n    }\n\n");
    text
}

/// The functions from a key to its number, and back.
fn number_functions(axes: &[RustAxis<'_>], ordinals: &Ordinals) -> String {
    let mut text = String::from(
        "\n    impl Key {\n        /// The number in the lock file: it stays what it is when axes and values are added.\n",
    );
    text.push_str("        pub const fn to_ordinal(&self) -> u64 {\n");
    let _ = write!(text, "            {}", ordinals.constant);
    for (named, adds) in axes.iter().zip(&ordinals.of_values) {
        let arms: Vec<String> = (0..adds.len())
            .map(|value| format!("{} => {}", named.value(value), adds[value]))
            .collect();
        let _ = write!(
            text,
            "\n                + match self.{} {{ {} }}",
            named.field,
            arms.join(", ")
        );
    }
    text.push_str("\n        }\n\n        /// The key of a number; `None` if there is none.\n");
    text.push_str("        pub fn from_ordinal(number: u64) -> ::core::option::Option<Self> {\n");
    let mutable = if ordinals.digits.is_empty() { "" } else { "mut " };
    let _ = writeln!(
        text,
        "            let {mutable}key = <Self as ::core::default::Default>::default();"
    );
    for digit in &ordinals.digits {
        let named = &axes[digit.axis];
        let _ = writeln!(text, "            match number / {} % {} {{", digit.weight, digit.radix);
        for (number, says) in digit.says.iter().enumerate() {
            let then = match says {
                Says::Value(value) => format!("key.{} = {}", named.field, named.value(*value)),
                Says::Nothing => "{}".to_owned(),
                Says::Gone => continue,
            };
            let _ = writeln!(text, "                {number} => {then},");
        }
        text.push_str("                _ => return ::core::option::Option::None,\n            }\n");
    }
    text.push_str("            if key.to_ordinal() == number { ::core::option::Option::Some(key) } else { ::core::option::Option::None }\n");
    text + "        }\n    }\n"
}

fn display_impl(axes: &[RustAxis<'_>]) -> String {
    let mut text = String::from(
        "    impl Key {\n        /// The canonical key, as a bundle's loader takes it.\n",
    );
    text.push_str("        pub fn to_key(&self) -> ::std::string::String {\n");
    text.push_str("            ::std::string::ToString::to_string(self)\n        }\n    }\n\n");
    text.push_str("    impl ::core::fmt::Display for Key {\n");
    text.push_str(
        "        fn fmt(&self, f: &mut ::core::fmt::Formatter<'_>) -> ::core::fmt::Result {\n",
    );
    if !axes.is_empty() {
        text.push_str("            let mut separator = \"\";\n");
    }
    for axis in axes {
        let _ = writeln!(text, "            if self.{} != {} {{", axis.field, axis.default());
        let _ = writeln!(text, "                {}", write_part(axis));
        let _ = writeln!(text, "                separator = \"{SEPARATOR}\";\n            }}");
    }
    let writes = format!("f.write_str(\"{DEFAULT}\")");
    let _ = match axes.is_empty() {
        true => writeln!(text, "            {writes}"),
        false => {
            writeln!(text, "            if separator.is_empty() {{ {writes} }} else {{ Ok(()) }}")
        }
    };
    text.push_str("        }\n    }\n");
    text
}

/// The statement that writes an axis which is not at its default.
fn write_part(RustAxis { axis, field, .. }: &RustAxis<'_>) -> String {
    match axis.kind {
        AxisKind::Bool => match axis.values.iter().find(|value| *value != default_setting(axis)) {
            Some(value) => {
                format!("::core::write!(f, \"{{separator}}{}\")?;", key_part(axis, value))
            }
            None => String::new(),
        },
        AxisKind::Enum | AxisKind::Int => {
            format!("::core::write!(f, \"{{separator}}{}={{}}\", self.{field}.name())?;", axis.name)
        }
    }
}
