//! Completion in a GLSL file.

use crate::failure::RequestError;
use std::collections::BTreeSet;

use serde_json::{Value, json};

use super::names::GlslNames;
use super::outline::SymbolKind;
use super::{OpenGlslFile, path_spellings, read_names};
use crate::LanguageServer;
use crate::complete::{
    CONSTANT, FIELD, FUNCTION, KEYWORD, MODULE, STRUCT, VARIABLE, completion_entry, of_library,
};
use crate::place::{self, Lines};
use lamplight_catalogue as catalogue;
use lamplight_compose::project::LIBRARY;
use lamplight_syntax::glsl::DIRECTIVES;
use lamplight_validate::glsl_words;

/// Words of statements and declarations.
const WORDS: &[&str] = &[
    "break",
    "buffer",
    "case",
    "const",
    "continue",
    "default",
    "discard",
    "do",
    "else",
    "flat",
    "for",
    "if",
    "in",
    "inout",
    "layout",
    "out",
    "precision",
    "return",
    "sampler2D",
    "samplerCube",
    "struct",
    "switch",
    "uniform",
    "void",
    "while",
];

/// `textDocument/completion`.
pub fn complete_at(server: &mut LanguageServer, parameters: &Value) -> Result<Value, RequestError> {
    let (document, byte) = server.requested_place(parameters)?;
    let text = document.text.clone();
    let word = place::word_at_byte(&text, byte).start.min(byte);
    let line = &text[text[..word].rfind('\n').map_or(0, |end| end + 1)..word];
    let Some(requested) = read_names(server, parameters)? else { return Ok(json!([])) };
    if let Some(path) = line.trim_start().strip_prefix("#include") {
        return Ok(complete_paths(&requested, path.trim_start()));
    }
    if line.trim() == "#" {
        let words = DIRECTIVES.iter().map(|word| completion_entry(word, KEYWORD, "directive"));
        return Ok(words.collect());
    }
    if line.trim_start().starts_with("#if") || line.trim_start().starts_with("#elif") {
        return Ok(complete_axes(&requested));
    }
    if line.ends_with('.') {
        return Ok(complete_members(&requested.names));
    }
    Ok(complete_names(server, &requested, &text, word..byte))
}

/// The files whose paths begin with what is written after `#include`.
fn complete_paths(requested: &OpenGlslFile, written: &str) -> Value {
    let Some(first) = written.chars().next().filter(|first| ['<', '"'].contains(first)) else {
        return json!([]);
    };
    let before = &written[1..];
    let mut parts = BTreeSet::new();
    for path in path_spellings(requested, first == '<') {
        let Some(rest) = path.strip_prefix(before) else { continue };
        let end = rest.find('/').map_or(rest.len(), |at| at + 1);
        parts.insert(rest[..end].to_owned());
    }
    parts.iter().map(|part| completion_entry(part, MODULE, "file")).collect()
}

/// Macros that stand for axes and their values.
fn complete_axes(requested: &OpenGlslFile) -> Value {
    let programs = requested.opened.manifest.iter().flat_map(|manifest| &manifest.programs);
    let mut found = BTreeSet::new();
    for axis in programs.flat_map(|program| program.space.axes()) {
        let name = axis.name.to_uppercase();
        for value in &axis.values {
            if let lamplight_permute::Setting::Name(value) = value {
                found.insert((format!("{name}_{}", value.to_uppercase()), "value"));
            }
        }
        found.insert((name, "axis"));
    }
    found.iter().map(|(name, what)| completion_entry(name, VARIABLE, what)).collect()
}

fn complete_members(names: &GlslNames) -> Value {
    let all = names.outlines.iter().flat_map(|outline| &outline.declarations);
    let members = all.filter(|found| found.kind == SymbolKind::Member);
    let found: BTreeSet<&str> = members.map(|found| names.graph.symbols.text(found.name)).collect();
    found.into_iter().map(|name| completion_entry(name, FIELD, "member")).collect()
}

/// Names in scope, those of the library with their includes, built-ins and keywords.
fn complete_names(
    server: &mut LanguageServer,
    requested: &OpenGlslFile,
    text: &str,
    written: std::ops::Range<usize>,
) -> Value {
    let prefix = text[written.clone()].to_lowercase();
    let mut found: Vec<Value> = Vec::new();
    let mut seen = BTreeSet::new();
    let mut add = |name: &str, value: Value| {
        if name.to_lowercase().starts_with(&prefix) && seen.insert(name.to_owned()) {
            found.push(value);
        }
    };
    let names = &requested.names;
    let spelt = |symbol| names.graph.symbols.text(symbol);
    for local in names.locals_at(written.start as u32) {
        add(spelt(local.name), completion_entry(spelt(local.name), VARIABLE, "local"));
    }
    for (file, outline) in names.outlines.iter().enumerate() {
        // The library's macros guard its files and give its names their prefix.
        let is_library = requested.package_of(file) == Some(LIBRARY);
        let path = &names.graph.paths[file];
        let declared = outline.declarations.iter().filter(|found| {
            found.kind != SymbolKind::Member && !(is_library && found.kind == SymbolKind::Macro)
        });
        for declaration in declared {
            let name = spelt(declaration.name);
            add(name, completion_entry(name, completion_kind(declaration.kind), path));
        }
    }
    if !prefix.is_empty() {
        for (name, value) in includable_items(&server.items(), text) {
            add(&name, value);
        }
    }
    for name in glsl_words() {
        add(name, completion_entry(name, FUNCTION, "built in"));
    }
    for name in WORDS {
        add(name, completion_entry(name, KEYWORD, "keyword"));
    }
    Value::Array(found)
}

/// The library's items, each with the edit that includes its file.
fn includable_items(known: &[catalogue::CatalogueModule], text: &str) -> Vec<(String, Value)> {
    let (lines, at) = (Lines::new(text), include_place(text));
    let items = known.iter().flat_map(|module| &module.items).filter(|item| item.glsl.is_some());
    let entry = |item: &catalogue::CatalogueItem| {
        let edit = json!({
            "range": lines.range(at..at),
            "newText": format!("{}\n", item.include()),
        });
        let value = json!({
            "label": item.name,
            "kind": of_library(item.kind),
            "detail": item.include(),
            "sortText": format!("~{}", item.name),
            "additionalTextEdits": [edit],
        });
        (item.name.clone(), value)
    };
    items.map(entry).collect()
}

/// Where to add an `#include`: after the last of `#include`, `#version` and `#extension`.
fn include_place(text: &str) -> usize {
    let (mut start, mut found) = (0, 0);
    for line in text.split_inclusive('\n') {
        start += line.len();
        let words = ["#include", "#version", "#extension"];
        if line.ends_with('\n') && words.iter().any(|word| line.trim_start().starts_with(word)) {
            found = start;
        }
    }
    found
}

fn completion_kind(kind: SymbolKind) -> u32 {
    match kind {
        SymbolKind::Function => FUNCTION,
        SymbolKind::Struct => STRUCT,
        SymbolKind::Constant | SymbolKind::Macro => CONSTANT,
        SymbolKind::Variable => VARIABLE,
        SymbolKind::Member => FIELD,
    }
}
