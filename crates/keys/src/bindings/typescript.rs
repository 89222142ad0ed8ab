//! Bindings for TypeScript: types of blocks, which `@lamplight/bundle` packs.

use std::fmt::Write;

use super::embed::base64_text;
use super::model::{FieldKind, ProgramModel, StructModel, identifier};
use super::{BindingLanguage, Request};
use crate::names::{Taken, camel_case, lower_camel};

pub const LANGUAGE: BindingLanguage = BindingLanguage { name: "ts", write };

const START: &str = "// Written by `lamplight bindings --lang ts`; do not edit.
import { packBlock, type Binding } from \"@lamplight/bundle\";
";

/// Words that are no names of constants.
const RESERVED: &[&str] = &["packBlock", "Binding", "default", "delete", "new", "class"];

fn write(request: &Request<'_>, programs: &[ProgramModel]) -> String {
    let mut taken = Taken::new(RESERVED);
    let mut text = START.to_owned();
    programs.iter().for_each(|program| text.push_str(&program_text(program, &mut taken)));
    if let Some((name, bytes)) = request.embedded {
        let name = taken.give(lower_camel(&identifier(name)));
        let _ = writeln!(
            text,
            "\n/** The bundle, as one file: for `openBytes`. */\nexport const {name} = Uint8Array.from(\n  atob(\"{}\"),\n  (letter) => letter.charCodeAt(0),\n);",
            base64_text(bytes)
        );
    }
    text
}

fn program_text(program: &ProgramModel, taken: &mut Taken) -> String {
    let prefix = identifier(&program.name);
    let mut text = String::new();
    let named = |found: &StructModel| {
        taken.give(camel_case(&format!("{prefix}_{}", identifier(&found.name))))
    };
    let names: Vec<String> = program.structs.iter().map(named).collect();
    for (found, name) in program.structs.iter().zip(&names) {
        text.push_str(&interface_text(found, name, &names));
    }
    for (index, found) in program.bindings.iter().enumerate() {
        let binding = &found.binding;
        let name = taken.give(lower_camel(&format!("{prefix}_{}", identifier(&binding.name))));
        let json = serde_json::to_string(binding).unwrap_or_default();
        let _ = writeln!(text, "\nexport const {name}: Binding = {json};");
        if let Some(block) = program.blocks.get(&index) {
            let ty = &names[*block];
            let _ = writeln!(
                text,
                "\n/** The bytes of a buffer for it. What is left out is 0. */\nexport const {}: (values: Partial<{ty}>) => ArrayBuffer = (values) =>\n  packBlock({name}, {{ ...values }});",
                taken.give(format!("{name}Bytes"))
            );
        }
    }
    for (location, input) in &program.inputs {
        let name = taken.give(lower_camel(&format!("{prefix}_input_{}", identifier(input))));
        let _ = writeln!(text, "\nexport const {name} = {location};");
    }
    text
}

/// A type alias rather than an interface, so that it is also a record of values.
fn interface_text(found: &StructModel, name: &str, names: &[String]) -> String {
    let mut text = format!("\nexport type {name} = {{\n");
    for field in found.fields.iter().filter(|field| !field.name.is_empty()) {
        let ty = match &field.kind {
            FieldKind::Numbers { lengths, .. } if lengths.is_empty() => "number".to_owned(),
            FieldKind::Numbers { .. } => "ArrayLike<number>".to_owned(),
            FieldKind::Struct { index, count: None } => names[*index].clone(),
            FieldKind::Struct { index, count: Some(_) } => format!("Partial<{}>[]", names[*index]),
            FieldKind::Bytes => continue,
        };
        let member = serde_json::to_string(&field.name).unwrap_or_default();
        let _ = writeln!(text, "  {member}: {ty};");
    }
    text + "};\n"
}
