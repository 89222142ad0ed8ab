//! Completion: what may be written at a position.

use crate::failure::RequestError;
use std::collections::BTreeSet;

use serde_json::{Value, json};

use super::package::{OpenedPackage, PackageModules};
use super::place::{self, Lines};
use super::{LanguageServer, actions, glsl};
use lamplight_catalogue::CatalogueItemKind;
use lamplight_diagnostic::source::Files;
use lamplight_permute::Setting;
use lamplight_syntax::wesl::{Item, ItemKind, Name, keywords};

/// The protocol's `CompletionItemKind`.
pub const FUNCTION: u32 = 3;
pub const FIELD: u32 = 5;
pub const VARIABLE: u32 = 6;
pub const MODULE: u32 = 9;
pub const VALUE: u32 = 12;
pub const KEYWORD: u32 = 14;
pub const CONSTANT: u32 = 21;
pub const STRUCT: u32 = 22;

/// `textDocument/completion`.
pub fn complete_at(server: &mut LanguageServer, parameters: &Value) -> Result<Value, RequestError> {
    if glsl::is_glsl(server, parameters) {
        return glsl::complete_at(server, parameters);
    }
    let (document, byte) = server.requested_place(parameters)?;
    let (root, path, text) = (document.root.clone(), document.path.clone(), document.text.clone());
    let word = place::word_at_byte(&text, byte).start;
    let line = text[..word].rfind('\n').map_or(0, |end| end + 1);
    let before = &text[line..word];
    let Some(modules) = server.modules(&root) else { return Ok(json!([])) };
    if let Some(condition) = before.rfind("@if(").max(before.rfind("@elif("))
        && before[condition..].matches('(').count() > before[condition..].matches(')').count()
    {
        return Ok(complete_flags(server, parameters, before));
    }
    if before.ends_with("::") {
        return Ok(path_members(server, &modules, &path, statement_before(&text, word)));
    }
    if before.ends_with('.') {
        return Ok(complete_fields(&modules, &path));
    }
    Ok(complete_names(server, &modules, &path, &text, word..byte))
}

pub fn completion_entry(label: &str, kind: u32, detail: &str) -> Value {
    json!({ "label": label, "kind": kind, "detail": detail })
}

/// From the start of the statement to a byte, without line breaks.
fn statement_before(text: &str, byte: usize) -> &str {
    let start = text[..byte].rfind([';', '}']).map_or(0, |end| end + 1);
    &text[start..byte]
}

/// Axes and features, or the values of the axis that is compared.
fn complete_flags(server: &LanguageServer, parameters: &Value, before: &str) -> Value {
    let Some(opened) =
        server.document(parameters).ok().and_then(|document| server.opened(&document.root))
    else {
        return json!([]);
    };
    let programs = || opened.manifest.iter().flat_map(|manifest| &manifest.programs);
    let axes = programs().flat_map(|program| program.space.axes());
    let compared = before.trim_end().strip_suffix("==").or(before.trim_end().strip_suffix("!="));
    if let Some(before) = compared {
        let before = before.trim_end();
        let name = &before[place::word_at_byte(before, before.len())];
        let values = axes.filter(|axis| axis.name == name).flat_map(|axis| &axis.values);
        let names: BTreeSet<String> = values.map(ToString::to_string).collect();
        return names.iter().map(|name| completion_entry(name, VALUE, "value")).collect();
    }
    let mut seen = BTreeSet::new();
    let axes = axes.filter(|axis| seen.insert(axis.name.clone())).map(|axis| {
        let values: Vec<String> = axis.values.iter().map(ToString::to_string).collect();
        completion_entry(&axis.name, VARIABLE, &format!("axis: {}", values.join(", ")))
    });
    let axes: Vec<Value> = axes.collect();
    let features = opened.features.declared.iter().map(|(name, feature)| {
        completion_entry(name, VARIABLE, feature.doc.as_deref().unwrap_or("feature"))
    });
    axes.into_iter().chain(features).collect()
}

/// Modules and items below the path that is written before the place.
fn path_members(
    server: &mut LanguageServer,
    modules: &PackageModules,
    here: &str,
    before: &str,
) -> Value {
    let path = written_path(before);
    let parts: Vec<&str> = path.iter().map(String::as_str).collect();
    let Some((first, rest)) = parts.split_first() else { return json!([]) };
    let document = server.documents.values().find(|document| document.path == here);
    let Some(opened) = document.and_then(|document| server.opened(&document.root)) else {
        return json!([]);
    };
    if *first == "constants" {
        return complete_constants(&opened);
    }
    let Some((files, label, folder)) = path_target(&opened, here, first, rest) else {
        return json!([]);
    };
    let prefix = if folder.is_empty() { String::new() } else { folder.join("/") + "/" };
    let below = files.list(&["wesl", "wgsl"]).into_iter().filter_map(|file| {
        let rest = file.strip_prefix(&prefix)?.to_owned();
        Some(rest.split(['/', '.']).next()?.to_owned())
    });
    let below: BTreeSet<String> = below.collect();
    let mut found: Vec<Value> =
        below.iter().map(|name| completion_entry(name, MODULE, "module")).collect();
    let label = std::iter::once(label).chain(folder.iter().copied()).collect::<Vec<_>>().join("::");
    let node = modules.graph.nodes.iter().find(|node| node.label == label);
    for item in node.into_iter().flat_map(|node| &node.module.items) {
        if item.name != Name::UNDERSCORE {
            found.push(completion_entry(
                modules.graph.names.text(item.name),
                completion_kind(item.kind),
                &label,
            ));
        }
    }
    // A module of the library that nothing imports yet.
    let known = server.items();
    let module = known.iter().find(|module| format!("lamplight::{}", module.path) == label);
    for item in module.filter(|_| node.is_none()).into_iter().flat_map(|module| &module.items) {
        found.push(completion_entry(&item.name, of_library(item.kind), item.summary()));
    }
    Value::Array(found)
}

/// The axes that `constants` has: those whose values are numbers or booleans.
fn complete_constants(opened: &OpenedPackage) -> Value {
    let programs = opened.manifest.iter().flat_map(|manifest| &manifest.programs);
    let axes = programs.flat_map(|program| program.space.axes());
    let is_number = |axis: &&lamplight_permute::Axis| {
        !matches!(axis.values.first(), Some(Setting::Name(_)) | None)
    };
    let names: BTreeSet<&str> = axes.filter(is_number).map(|axis| axis.name.as_str()).collect();
    names.into_iter().map(|name| completion_entry(name, CONSTANT, "constant")).collect()
}

/// The package that a path leads into: its files, its name, and the names of the path from its
/// root. `None` if there is no such package.
fn path_target<'p>(
    opened: &'p OpenedPackage,
    here: &'p str,
    first: &'p str,
    rest: &[&'p str],
) -> Option<(&'p dyn Files, &'p str, Vec<&'p str>)> {
    let root = &*opened.packages.root.files;
    match first {
        "package" => Some((root, "package", rest.to_vec())),
        "super" => {
            let stem = here.rsplit_once('.').map_or(here, |(stem, _)| stem);
            let above: Vec<&str> = stem.split('/').collect();
            let ups = 1 + rest.iter().take_while(|part| **part == "super").count();
            let kept = above.len().saturating_sub(ups);
            let folder = above[..kept].iter().chain(&rest[ups - 1..]).copied().collect();
            Some((root, "package", folder))
        }
        name => {
            let package = opened.packages.dependency(name)?;
            Some((&*package.files, name, rest.to_vec()))
        }
    }
}

/// The names of the path before a place, those outside the braces of an import included.
fn written_path(before: &str) -> Vec<String> {
    let mut parts: Vec<String> = Vec::new();
    let mut rest = before.trim_end();
    loop {
        while let Some(shorter) = rest.strip_suffix("::") {
            let name = place::word_at_byte(shorter, shorter.len());
            if name.is_empty() {
                break;
            }
            parts.push(shorter[name.clone()].to_owned());
            rest = shorter[..name.start].trim_end();
        }
        // `import a::{b, c::`: continues with the path before the open brace.
        let mut depth = 0;
        let open = rest.char_indices().rev().find(|(_, letter)| {
            depth += i32::from(*letter == '}') - i32::from(*letter == '{');
            depth < 0
        });
        match open {
            Some((at, _)) if rest.trim_start().contains("import") => rest = rest[..at].trim_end(),
            _ => break,
        }
        if !rest.ends_with("::") {
            break;
        }
    }
    parts.reverse();
    parts
}

/// Members of the structs of a module and of what it reaches by name.
fn complete_fields(modules: &PackageModules, here: &str) -> Value {
    let Some(node) = modules.node(here) else { return json!([]) };
    let mut found = BTreeSet::new();
    let symbols = modules.places_in(node).map(|(symbol, _)| symbol);
    for (node, item) in symbols.filter_map(|symbol| modules.item(symbol)) {
        if item.kind != ItemKind::Struct {
            continue;
        }
        let text = &node.module.text[item.name_range.end as usize..item.range.end as usize];
        for line in text.lines() {
            let Some((name, _)) = line.split("//").next().unwrap_or_default().split_once(':')
            else {
                continue;
            };
            found.insert(name[place::word_at_byte(name, name.trim_end().len())].to_owned());
        }
    }
    let owner = |name: &String| completion_entry(name, FIELD, "member");
    found.iter().filter(|name| !name.is_empty()).map(owner).collect()
}

/// Names in scope, those that can be imported, built-ins and keywords.
fn complete_names(
    server: &mut LanguageServer,
    modules: &PackageModules,
    here: &str,
    text: &str,
    written: std::ops::Range<usize>,
) -> Value {
    let prefix = text[written.clone()].to_lowercase();
    let fits = |name: &str| name.to_lowercase().starts_with(&prefix);
    let mut found: Vec<Value> = Vec::new();
    let mut seen = BTreeSet::new();
    let mut add = |name: &str, value: Value| {
        if fits(name) && seen.insert(name.to_owned()) {
            found.push(value);
        }
    };
    for (name, value) in in_scope(modules, here, written.start as u32) {
        add(name, value);
    }
    if !prefix.is_empty() {
        let (lines, place) = (Lines::new(text), actions::import_place(text));
        let items = importable_items(server, modules, here).into_iter();
        for (path, name, kind) in items.filter(|(_, name, _)| fits(name)) {
            let edit = actions::import_edit_at(text, &lines, place, &path);
            let value = json!({
                "label": name,
                "kind": kind,
                "detail": format!("import {path}"),
                "sortText": format!("~{name}"),
                "additionalTextEdits": [edit],
            });
            add(&name, value);
        }
    }
    for name in naga::keywords::wgsl::BUILTIN_IDENTIFIERS.iter().copied() {
        add(name, completion_entry(name, FUNCTION, "built in"));
    }
    for name in keywords() {
        add(name, completion_entry(name, KEYWORD, "keyword"));
    }
    Value::Array(found)
}

/// Locals, items and imports that a byte of a module can name, the nearest first.
fn in_scope<'m>(modules: &'m PackageModules, here: &str, at: u32) -> Vec<(&'m str, Value)> {
    let Some(node) = modules.node(here).map(|node| &modules.graph.nodes[node as usize]) else {
        return Vec::new();
    };
    let named = |name| modules.graph.names.text(name);
    let around = node.module.items.iter().find(|item| item.range.contains(&at));
    let locals: BTreeSet<&str> =
        around.into_iter().flat_map(|item| &item.locals).map(|local| named(*local)).collect();
    let locals = locals.into_iter().map(|local| (local, VARIABLE, "local"));
    let items = node.module.items.iter().filter(|item| item.name != Name::UNDERSCORE);
    let items = items.map(|item| (named(item.name), completion_kind(item.kind), &*node.label));
    let imports = node.module.imports.iter();
    let imports = imports.map(|import| (named(import.alias), VARIABLE, "imported"));
    let all = locals.chain(items).chain(imports);
    all.map(|(name, kind, detail)| (name, completion_entry(name, kind, detail))).collect()
}

/// Items of other modules and of the library: path, name, kind.
pub fn importable_items(
    server: &mut LanguageServer,
    modules: &PackageModules,
    here: &str,
) -> Vec<(String, String, u32)> {
    let own = modules.node(here);
    let mut found = Vec::new();
    for (index, node) in modules.graph.nodes.iter().enumerate() {
        if Some(index as u32) == own || node.label.starts_with("lamplight::") {
            continue;
        }
        let here = own.map(|own| &modules.graph.nodes[own as usize]);
        let is_shown = |item: &&Item| {
            item.name != Name::UNDERSCORE && here.is_none_or(|here| node.shows(item, here))
        };
        for item in node.module.items.iter().filter(is_shown) {
            let name = modules.graph.names.text(item.name).to_owned();
            found.push((format!("{}::{name}", node.label), name, completion_kind(item.kind)));
        }
    }
    for module in server.items().iter() {
        let items = module.items.iter();
        found
            .extend(items.map(|item| (item.full_path(), item.name.clone(), of_library(item.kind))));
    }
    found
}

fn completion_kind(kind: ItemKind) -> u32 {
    match kind {
        ItemKind::Function => FUNCTION,
        ItemKind::Struct | ItemKind::Alias => STRUCT,
        ItemKind::Const | ItemKind::Override => CONSTANT,
        ItemKind::Var | ItemKind::ConstAssert => VARIABLE,
    }
}

pub fn of_library(kind: CatalogueItemKind) -> u32 {
    match kind {
        CatalogueItemKind::Function => FUNCTION,
        CatalogueItemKind::Struct => STRUCT,
        CatalogueItemKind::Constant => CONSTANT,
    }
}
