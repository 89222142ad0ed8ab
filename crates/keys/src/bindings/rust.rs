//! Bindings for Rust: one module a program, to `include!` or to keep as a file.

use std::fmt::Write;

use super::embed::byte_lines;
use super::model::{FieldKind, FieldModel, ProgramModel, StructModel, identifier};
use super::{BindingLanguage, Request};
use crate::names::{Taken, camel_case};
use crate::rust::KEYWORDS;

pub const LANGUAGE: BindingLanguage = BindingLanguage { name: "rust", write };

/// The generated code has these: an engine uses only some of the items, names are those of the shaders,
/// and formatting its sources must not make the file differ from what `--check` compares it with.
const ATTRIBUTES: &str = "#[allow(dead_code, non_snake_case, non_camel_case_types, clippy::all)]\n\
                          #[rustfmt::skip]";

fn write(request: &Request<'_>, programs: &[ProgramModel]) -> String {
    let mut taken = Taken::new(KEYWORDS);
    let mut text = String::from("// Written by `lamplight bindings --lang rust`; do not edit.\n");
    for program in programs {
        text.push_str(&program_module(program, &taken.give(identifier(&program.name))));
    }
    if let Some((name, bytes)) = request.embedded {
        let name = taken.give(identifier(name).to_uppercase());
        let (length, lines) = (bytes.len(), byte_lines(bytes));
        let _ = write!(
            text,
            "\n/// The bundle, as one file.\n{ATTRIBUTES}\npub static {name}: [u8; {length}] = [\n{lines}];\n"
        );
    }
    text
}

fn program_module(program: &ProgramModel, name: &str) -> String {
    let mut text =
        format!("\n/// Bindings of program `{name}`.\n{ATTRIBUTES}\npub mod {name} {{\n");
    let mut taken = Taken::new(KEYWORDS);
    for found in &program.bindings {
        let binding = &found.binding;
        let name = taken.give(identifier(&binding.name).to_uppercase());
        let _ = writeln!(
            text,
            "    /// Group and binding.\n    pub const {name}: (u32, u32) = ({}, {});",
            binding.group, binding.binding
        );
    }
    for (location, name) in &program.inputs {
        let name = taken.give(format!("INPUT_{}", identifier(name).to_uppercase()));
        let _ = writeln!(
            text,
            "    /// Location of the vertex input.\n    pub const {name}: u32 = {location};"
        );
    }
    let named = |found: &StructModel| taken.give(camel_case(&identifier(&found.name)));
    let names: Vec<String> = program.structs.iter().map(named).collect();
    for (found, name) in program.structs.iter().zip(&names) {
        text.push_str(&struct_text(found, name, &names));
    }
    text + "}\n"
}

const METHODS: &str = "    };

        /// The bytes of a buffer.
        pub fn as_bytes(&self) -> &[u8] {
            // SAFETY: the structure has no padding but its own fields, as is asserted above, so each
            // of its bytes is initialised; and the slice borrows it.
            unsafe {
                core::slice::from_raw_parts(core::ptr::from_ref(self).cast(), size_of::<Self>())
            }
        }
    }
    impl Default for NAME {
        fn default() -> Self {
            Self::ZERO
        }
    }
";

fn struct_text(found: &StructModel, name: &str, names: &[String]) -> String {
    let mut fields = Taken::new(KEYWORDS);
    let mut text = format!(
        "\n    #[repr(C)]\n    #[derive(Clone, Copy, Debug, PartialEq)]\n    pub struct {name} {{\n"
    );
    let (mut asserted, mut zeros) = (String::new(), String::new());
    let mut sizes = Vec::new();
    for field in &found.fields {
        let field_name = match field.name.is_empty() {
            true => fields.give(format!("padding_{}", field.offset)),
            false => fields.give(identifier(&field.name)),
        };
        let (ty, zero) = type_and_zero(field, names);
        let _ = writeln!(text, "        pub {field_name}: {ty},");
        let _ = writeln!(zeros, "            {field_name}: {zero},");
        let offset = field.offset;
        let _ = writeln!(
            asserted,
            "    const _: () = assert!(core::mem::offset_of!({name}, {field_name}) == {offset});"
        );
        sizes.push(format!("size_of::<{ty}>()"));
    }
    let _ = writeln!(text, "    }}");
    let _ = writeln!(asserted, "    const _: () = assert!(size_of::<{name}>() == {});", found.size);
    let sum = sizes.join(" + ");
    let _ = writeln!(asserted, "    const _: () = assert!({sum} == {});", found.size);
    text.push_str(&asserted);
    let _ = write!(text, "    impl {name} {{\n        pub const ZERO: Self = Self {{\n{zeros}    ");
    text + &METHODS.replace("NAME", name)
}

/// The type of a field, and its zero.
fn type_and_zero(field: &FieldModel, names: &[String]) -> (String, String) {
    match &field.kind {
        FieldKind::Numbers { scalar, lengths } => {
            // Rust has no stable type for half floats.
            let scalar = if scalar == "f16" { "u16" } else { scalar };
            let zero = if scalar.starts_with('f') { "0.0" } else { "0" };
            let start = (scalar.to_owned(), zero.to_owned());
            lengths.iter().rev().fold(start, |(ty, zero), length| {
                (format!("[{ty}; {length}]"), format!("[{zero}; {length}]"))
            })
        }
        FieldKind::Struct { index, count } => {
            let (ty, zero) = (names[*index].clone(), format!("{}::ZERO", names[*index]));
            match count {
                Some(count) => (format!("[{ty}; {count}]"), format!("[{zero}; {count}]")),
                None => (ty, zero),
            }
        }
        FieldKind::Bytes => (format!("[u8; {}]", field.size), format!("[0; {}]", field.size)),
    }
}
