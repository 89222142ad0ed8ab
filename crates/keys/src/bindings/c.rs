//! Bindings for C and for C++: one header.

use std::fmt::Write;

use super::embed::byte_lines;
use super::model::{FieldKind, FieldModel, ProgramModel, StructModel, identifier};
use super::{BindingLanguage, Request};
use crate::c::KEYWORDS;
use crate::names::Taken;

pub const C: BindingLanguage = BindingLanguage { name: "c", write: write_c };
pub const CPP: BindingLanguage = BindingLanguage { name: "cpp", write: write_cpp };

const START: &str = "/* Written by `lamplight bindings --lang LANG`; do not edit. */
#ifndef GUARD
#define GUARD

#include <stddef.h>
#include <stdint.h>
";

/// How the two languages differ.
struct Dialect {
    name: &'static str,
    is_cpp: bool,
}

const C_DIALECT: Dialect = Dialect { name: "c", is_cpp: false };
const CPP_DIALECT: Dialect = Dialect { name: "cpp", is_cpp: true };

fn write_c(request: &Request<'_>, programs: &[ProgramModel]) -> String {
    write_header(request, programs, &C_DIALECT)
}

fn write_cpp(request: &Request<'_>, programs: &[ProgramModel]) -> String {
    write_header(request, programs, &CPP_DIALECT)
}

fn write_header(request: &Request<'_>, programs: &[ProgramModel], dialect: &Dialect) -> String {
    let names: Vec<&str> = programs.iter().map(|program| program.name.as_str()).collect();
    let hash = blake3::hash(names.join("\n").as_bytes()).to_hex();
    let guard = format!("LAMPLIGHT_BINDINGS_{}_H", hash[..16].to_uppercase());
    let mut text = START.replace("LANG", dialect.name).replace("GUARD", &guard);
    let mut taken = Taken::new(KEYWORDS);
    let program_texts = programs.iter().map(|program| match dialect.is_cpp {
        true => namespace_text(program, &taken.give(identifier(&program.name))),
        false => {
            program_text(program, &format!("{}_", identifier(&program.name)), dialect, &mut taken)
        }
    });
    program_texts.for_each(|program| text.push_str(&program));
    if let Some((name, bytes)) = request.embedded {
        let name = taken.give(identifier(name));
        let _ = write!(
            text,
            "\n/* The bundle, as one file. */\nstatic const unsigned char {name}[{}] = {{\n{}}};\n",
            bytes.len(),
            byte_lines(bytes)
        );
    }
    text + "\n#endif\n"
}

/// Each program of C++ has a namespace, so that its names clash with no others.
fn namespace_text(program: &ProgramModel, name: &str) -> String {
    let text = program_text(program, "", &CPP_DIALECT, &mut Taken::new(KEYWORDS));
    format!("\nnamespace {name} {{{text}}} /* namespace {name} */\n")
}

fn program_text(
    program: &ProgramModel,
    prefix: &str,
    dialect: &Dialect,
    taken: &mut Taken,
) -> String {
    let mut text = format!("\n/* Program `{}`. */\n", identifier(&program.name));
    text.push_str(&numbers_text(program, &prefix.to_uppercase(), taken));
    let named = |found: &StructModel| taken.give(format!("{prefix}{}", identifier(&found.name)));
    let names: Vec<String> = program.structs.iter().map(named).collect();
    for (found, name) in program.structs.iter().zip(&names) {
        text.push_str(&struct_text(found, name, &names, dialect));
    }
    text
}

/// Numbers of bindings, sizes of blocks, locations of inputs.
fn numbers_text(program: &ProgramModel, prefix: &str, taken: &mut Taken) -> String {
    let mut lines = Vec::new();
    for found in &program.bindings {
        let binding = &found.binding;
        let name = format!("{prefix}{}", identifier(&binding.name).to_uppercase());
        lines.push((format!("{name}_GROUP"), binding.group));
        lines.push((format!("{name}_BINDING"), binding.binding));
        lines.extend(binding.size.map(|size| (format!("{name}_SIZE"), size)));
    }
    for (location, name) in &program.inputs {
        lines.push((format!("{prefix}INPUT_{}", identifier(name).to_uppercase()), *location));
    }
    let line = |(name, number): (String, u32)| format!("    {} = {number}", taken.give(name));
    let lines: Vec<String> = lines.into_iter().map(line).collect();
    if lines.is_empty() { String::new() } else { format!("enum {{\n{}\n}};\n", lines.join(",\n")) }
}

fn struct_text(found: &StructModel, name: &str, names: &[String], dialect: &Dialect) -> String {
    let mut fields = Taken::new(KEYWORDS);
    let mut text = match dialect.is_cpp {
        true => format!("\nstruct {name} {{\n"),
        false => format!("\ntypedef struct {name} {{\n"),
    };
    let mut asserted = Vec::new();
    for field in &found.fields {
        let field_name = match field.name.is_empty() {
            true => fields.give(format!("padding_{}", field.offset)),
            false => fields.give(identifier(&field.name)),
        };
        let _ = writeln!(text, "    {};", declaration(field, &field_name, names));
        asserted.push((format!("offsetof({name}, {field_name})"), field.offset, field_name));
    }
    text.push_str(&if dialect.is_cpp { "};\n".to_owned() } else { format!("}} {name};\n") });
    asserted.push((format!("sizeof({name})"), found.size, "size".to_owned()));
    for (what, number, field) in asserted {
        let _ = match dialect.is_cpp {
            true => writeln!(text, "static_assert({what} == {number}, \"{field}\");"),
            // C99 has no assertions for compilers: an array of a negative length is an error.
            false => {
                writeln!(text, "typedef char {name}_{field}_checked[{what} == {number} ? 1 : -1];")
            }
        };
    }
    text
}

fn declaration(field: &FieldModel, name: &str, names: &[String]) -> String {
    match &field.kind {
        FieldKind::Numbers { scalar, lengths } => {
            let lengths: String = lengths.iter().map(|length| format!("[{length}]")).collect();
            format!("{} {name}{lengths}", scalar_type(scalar))
        }
        FieldKind::Struct { index, count } => {
            let count = count.map_or(String::new(), |count| format!("[{count}]"));
            format!("{} {name}{count}", names[*index])
        }
        FieldKind::Bytes => format!("uint8_t {name}[{}]", field.size),
    }
}

fn scalar_type(scalar: &str) -> &'static str {
    match scalar {
        "f32" => "float",
        "f64" => "double",
        "i32" => "int32_t",
        "i64" => "int64_t",
        "u64" => "uint64_t",
        "i16" => "int16_t",
        // There is no type for half floats in C99.
        "f16" | "u16" => "uint16_t",
        _ => "uint32_t",
    }
}
