//! What a name is, in words: hover and signatures.

use crate::failure::RequestError;
use std::sync::Arc;

use serde_json::{Value, json};

use super::members::members_at;
use super::package::{OpenedPackage, PackageModules, WeslSymbol};
use super::place;
use super::report::hover_json;
use super::{LanguageServer, glsl, look};
use lamplight_catalogue::{self as catalogue, CatalogueItem, cost, pages};
use lamplight_compose::project::LIBRARY;
use lamplight_diagnostic::source::SourceSet;
use lamplight_syntax::wesl::ItemKind;

/// `textDocument/hover`.
pub fn hover_at(server: &mut LanguageServer, parameters: &Value) -> Result<Value, RequestError> {
    if glsl::is_glsl(server, parameters) {
        return glsl::hover_at(server, parameters);
    }
    let Some((modules, symbol, span)) = server.symbol(parameters)? else {
        return hover_member(server, parameters);
    };
    let document = server.document(parameters)?;
    let (root, path) = (document.root.clone(), document.path.clone());
    let text = match symbol {
        WeslSymbol::Items { .. } => {
            let known = server.items();
            describe_item(&modules, symbol, &known)
        }
        WeslSymbol::Local { node, declared } => {
            let text = &modules.graph.nodes[node as usize].module.text;
            let start = text[..declared as usize].rfind('\n').map_or(0, |end| end + 1);
            let line = text[start..].lines().next().unwrap_or_default().trim();
            Some(format!("```wgsl\n{line}\n```"))
        }
        WeslSymbol::Flag(name) => {
            let opened = server.opened(&root);
            let name = modules.graph.names.text(name).to_owned();
            opened.map(|opened| describe_flag(server, &opened, &path, &name))
        }
        WeslSymbol::Constant(index) => {
            let name = modules.graph.constants.get(index as usize);
            let name = name.map(|found| modules.graph.names.text(found.name).to_owned());
            let opened = server.opened(&root).zip(name);
            opened.map(|(opened, name)| describe_flag(server, &opened, &path, &name))
        }
    };
    let Some(text) = text else { return Ok(Value::Null) };
    Ok(hover_json(&text, &modules.sources.get(span.source).text, span.range()))
}

/// Hover for a name after a dot: the members that it may mean, each with its struct.
fn hover_member(server: &mut LanguageServer, parameters: &Value) -> Result<Value, RequestError> {
    let Some((modules, node, byte)) = server.requested_module(parameters)? else {
        return Ok(Value::Null);
    };
    let Some((span, found)) = members_at(&modules, node, byte) else { return Ok(Value::Null) };
    if found.is_empty() {
        return Ok(Value::Null);
    }
    let descriptions = found.iter().map(|member| {
        let owner = modules.graph.names.text(member.item.name);
        format!("```wgsl\n{}\n```\n`{}::{owner}`", member.text, member.node.label)
    });
    let text = descriptions.collect::<Vec<_>>().join("\n\n");
    Ok(hover_json(&text, &modules.sources.get(span.source).text, span.range()))
}

/// An item of the library as `show` prints it; any other by its comment and declaration.
fn describe_item(
    modules: &PackageModules,
    symbol: WeslSymbol,
    known: &[catalogue::CatalogueModule],
) -> Option<String> {
    let (node, found) = modules.item(symbol)?;
    let name = modules.graph.names.text(found.name);
    if let Some(path) = node.label.strip_prefix(&format!("{LIBRARY}::")) {
        let module = known.iter().find(|module| module.path == path);
        let item = module.and_then(|module| module.items.iter().find(|item| item.name == name));
        if let Some(item) = item {
            return Some(of_library(item, "wgsl", &item.wesl, &item.import()));
        }
    }
    let text = &node.module.text[found.range.start as usize..found.range.end as usize];
    let (comments, code): (Vec<&str>, Vec<&str>) =
        text.lines().partition(|line| line.trim_start().starts_with("//"));
    let code = code.join("\n");
    let code = match found.kind {
        ItemKind::Function => code.split('{').next().unwrap_or_default(),
        _ => &code,
    };
    let comments = comments.iter().map(|line| line.trim().trim_start_matches('/').trim());
    let comments = comments.collect::<Vec<_>>().join("\n");
    Some(format!("```wgsl\n{}\n```\n{comments}\n\n`{}`", code.trim(), node.label))
}

/// Signature, documentation, formula and error model.
pub fn of_library(item: &CatalogueItem, language: &str, code: &str, usage: &str) -> String {
    let mut text = format!("```{language}\n{}\n```\n", code.trim_end_matches(['{', ' ', '\n']));
    for paragraph in item.paragraphs() {
        text += &format!("\n{paragraph}\n");
    }
    for section in catalogue::SECTIONS {
        if let Some(words) = item.section(section) {
            text += &format!("\n**{section}**: {words}\n");
        }
    }
    text + &format!("\n`{usage}`")
}

/// An axis with its values, what it multiplies and what it costs, or a feature.
pub fn describe_flag(
    server: &LanguageServer,
    opened: &OpenedPackage,
    path: &str,
    name: &str,
) -> String {
    let (settings, _) = look::module_settings(opened, path, &server.choice(&opened.root));
    let value = settings.values.get(name).map(ToString::to_string);
    let value = value.or_else(|| settings.constants.get(name).cloned());
    let shown = value.map_or("no value".to_owned(), |value| format!("`{value}`"));
    let mut text = format!("`{name}`: {shown} here\n");
    let mut apart = SourceSet::default();
    let costs = cost::package_costs(&mut apart, &opened.packages.root).ok();
    let programs = opened.manifest.iter().flat_map(|manifest| &manifest.programs);
    for program in programs {
        let Some(axis) = program.space.axis(name) else { continue };
        let values: Vec<String> = axis.values.iter().map(|value| format!("`{value}`")).collect();
        text += &format!("\nAxis of `{}`: {}.", program.name, values.join(", "));
        text += &axis.doc.as_ref().map_or(String::new(), |doc| format!(" {doc}"));
        text += &format!(
            "\n\nIts {} values multiply what the others leave; the program has {} permutations.\n",
            axis.values.len(),
            program.space.count()
        );
        let cost =
            costs.as_ref().and_then(|costs| pages::cost::of_axis(&program.name, name, costs));
        text += &cost.map_or(String::new(), |cost| format!("\n{cost}"));
    }
    if let Some(feature) = opened.features.declared.get(name) {
        let default = if feature.default { "on" } else { "off" };
        text += &format!("\nFeature, {default} by default.");
        text += &feature.doc.as_ref().map_or(String::new(), |doc| format!(" {doc}"));
        for (other, _) in &feature.excludes {
            text += &format!("\n\nNever on together with `{other}`.");
        }
    }
    text
}

/// `textDocument/signatureHelp`: of the call that the position is in.
pub fn signature_help(
    server: &mut LanguageServer,
    parameters: &Value,
) -> Result<Value, RequestError> {
    if glsl::is_glsl(server, parameters) {
        return glsl::signature_help(server, parameters);
    }
    let (document, byte) = server.requested_place(parameters)?;
    let Some((name, argument)) = call_around(&document.text, byte) else { return Ok(Value::Null) };
    let (root, path) = (document.root.clone(), document.path.clone());
    let word = document.text[name.clone()].to_owned();
    let Some(modules) = server.modules(&root) else { return Ok(Value::Null) };
    let known: Arc<Vec<catalogue::CatalogueModule>> = server.items();
    let symbol = modules.node(&path).and_then(|node| {
        let (symbol, _) = modules.symbol(node, name.end as u32)?;
        Some(symbol)
    });
    let declared = symbol.and_then(|symbol| {
        let (node, item) = modules.item(symbol)?;
        let text = &node.module.text[item.name_range.start as usize..item.range.end as usize];
        Some(format!("fn {}", text.split('{').next().unwrap_or_default().trim()))
    });
    let of_library = || {
        let mut items = known.iter().flat_map(|module| &module.items);
        let found = items.find(|item| item.name == word)?;
        Some(found.wesl.trim_end_matches(['{', ' ', '\n']).to_owned())
    };
    let Some(label) = declared.or_else(of_library) else { return Ok(Value::Null) };
    let list = label.split_once('(').and_then(|(_, rest)| Some(rest.rsplit_once(')')?.0));
    let parts = list.into_iter().flat_map(|list| list.split(','));
    let parts = parts.map(|part| json!({ "label": part.trim() })).collect::<Vec<_>>();
    Ok(json!({
        "signatures": [{ "label": label, "parameters": parts }],
        "activeSignature": 0,
        "activeParameter": argument,
    }))
}

/// The name of the call around a byte, and which of its arguments the byte is in.
pub fn call_around(text: &str, byte: usize) -> Option<(std::ops::Range<usize>, usize)> {
    let (mut depth, mut argument) = (0, 0);
    for (at, letter) in text[..byte].char_indices().rev() {
        match letter {
            ')' | ']' => depth += 1,
            '(' if depth == 0 => {
                let name = place::word_at_byte(text, at);
                return (!name.is_empty()).then_some((name, argument));
            }
            '(' | '[' => depth -= 1,
            ',' if depth == 0 => argument += 1,
            ';' | '{' | '}' => return None,
            _ => {}
        }
    }
    None
}
