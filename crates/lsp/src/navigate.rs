//! Definitions, references, renaming and lists of symbols.

use crate::failure::RequestError;
use std::collections::BTreeSet;
use std::sync::Arc;

use serde_json::{Value, json};

use super::dependents::{PackageSymbol, SharedSymbol};
use super::members::members_at;
use super::package::{PackageModules, WeslSymbol};
use super::place::Lines;
use super::places::Places;
use super::{LanguageServer, glsl, report};
use lamplight_compose::project;
use lamplight_diagnostic::source::{SourceSet, Span};
use lamplight_syntax::wesl::{ItemKind, Name, is_keyword, is_path_name};
use lamplight_syntax::words::is_word;

/// The most symbols in an answer to `workspace/symbol`.
const SYMBOLS: usize = 500;

impl LanguageServer {
    /// What parameters ask about: the modules of its package, the symbol, and its place.
    pub(super) fn symbol(
        &mut self,
        parameters: &Value,
    ) -> Result<Option<(Arc<PackageModules>, WeslSymbol, Span)>, RequestError> {
        let Some((modules, node, byte)) = self.requested_module(parameters)? else {
            return Ok(None);
        };
        let found = modules
            .symbol(node, byte as u32)
            .map(|(symbol, range)| (symbol, modules.graph.nodes[node as usize].module.span(range)));
        Ok(found.map(|(symbol, span)| (modules, symbol, span)))
    }

    /// The modules of the package that parameters name, with the module and the byte in it.
    pub(super) fn requested_module(
        &mut self,
        parameters: &Value,
    ) -> Result<Option<(Arc<PackageModules>, u32, usize)>, RequestError> {
        let (document, byte) = self.requested_place(parameters)?;
        let (root, path) = (document.root.clone(), document.path.clone());
        let Some(modules) = self.modules(&root) else { return Ok(None) };
        let node = modules.node(&path);
        Ok(node.map(|node| (modules, node, byte)))
    }

    /// The places of a package's texts.
    pub(super) fn places<'s>(&'s self, sources: &'s SourceSet) -> Places<'s> {
        Places::new(sources, &*self.library)
    }
}

/// `textDocument/definition`.
pub fn definition_at(
    server: &mut LanguageServer,
    parameters: &Value,
) -> Result<Value, RequestError> {
    if glsl::is_glsl(server, parameters) {
        return glsl::definition_at(server, parameters);
    }
    let Some((modules, symbol, _)) = server.symbol(parameters)? else {
        let Some((modules, node, byte)) = server.requested_module(parameters)? else {
            return Ok(Value::Null);
        };
        let Some((_, found)) = members_at(&modules, node, byte) else { return Ok(Value::Null) };
        let places = server.places(&modules.sources);
        return Ok(found.iter().filter_map(|member| places.location(member.place)).collect());
    };
    let places = server.places(&modules.sources);
    let declarations = modules.declarations(symbol);
    Ok(declarations.into_iter().filter_map(|span| places.location(span)).collect())
}

/// `textDocument/references`.
pub fn references_at(
    server: &mut LanguageServer,
    parameters: &Value,
) -> Result<Value, RequestError> {
    if glsl::is_glsl(server, parameters) {
        return glsl::references_at(server, parameters);
    }
    let Some((modules, symbol, _)) = server.symbol(parameters)? else { return Ok(json!([])) };
    let root = server.document(parameters)?.root.clone();
    let declared = parameters.pointer("/context/includeDeclaration").and_then(Value::as_bool);
    let mut found = Vec::new();
    for package in server.shared_symbol(&root, &modules, symbol).packages {
        let modules = &package.modules;
        let declarations = modules.declarations(package.symbol);
        let spans = package.references().into_iter();
        let spans = spans.filter(|span| declared != Some(false) || !declarations.contains(span));
        let places = server.places(&modules.sources);
        found.extend(spans.filter_map(|span| places.location(span)));
    }
    Ok(Value::Array(found))
}

/// Why a symbol cannot be renamed; `None` if it can.
fn why_fixed(shared: &SharedSymbol, symbol: WeslSymbol) -> Option<&'static str> {
    match symbol {
        WeslSymbol::Items { .. } if !shared.is_at_home => {
            Some("it is declared in a package that is not in the folders of the editor")
        }
        WeslSymbol::Items { .. } | WeslSymbol::Local { .. } => None,
        WeslSymbol::Flag(_) => Some("axes and features are named in more than these files"),
        WeslSymbol::Constant(_) => Some("constants come from outside"),
    }
}

/// Fails for the copy of the library that editors show: edits there would be lost when it is
/// written again.
fn refuse_copy(server: &LanguageServer, parameters: &Value) -> Result<(), RequestError> {
    let root = &server.document(parameters)?.root;
    let copy = (server.library)(project::MANIFEST);
    let is_copy = copy.and_then(|file| file.parent()?.canonicalize().ok()).as_ref() == Some(root);
    if is_copy { Err("this is a copy of the library".to_owned().into()) } else { Ok(()) }
}

/// `textDocument/prepareRename`.
pub fn prepare_rename(
    server: &mut LanguageServer,
    parameters: &Value,
) -> Result<Value, RequestError> {
    refuse_copy(server, parameters)?;
    if glsl::is_glsl(server, parameters) {
        return glsl::prepare_rename(server, parameters);
    }
    let Some((modules, symbol, span)) = server.symbol(parameters)? else {
        return Ok(Value::Null);
    };
    let root = server.document(parameters)?.root.clone();
    let shared = server.shared_symbol(&root, &modules, symbol);
    if let Some(reason) = why_fixed(&shared, symbol) {
        return Err(reason.to_owned().into());
    }
    let text = &modules.sources.get(span.source).text;
    Ok(Lines::new(text).range(last_name(text, span).range()))
}

/// The last name of a path.
fn last_name(text: &str, span: Span) -> Span {
    let written = text.get(span.range()).unwrap_or_default();
    let start = written.rfind("::").map_or(0, |at| at + "::".len());
    let blank = written[start..].len() - written[start..].trim_start().len();
    Span { start: span.start + (start + blank) as u32, ..span }
}

/// `textDocument/rename`: each place that writes the name; those that write an alias stay.
pub fn rename_symbol(
    server: &mut LanguageServer,
    parameters: &Value,
) -> Result<Value, RequestError> {
    refuse_copy(server, parameters)?;
    if glsl::is_glsl(server, parameters) {
        return glsl::rename_symbol(server, parameters);
    }
    let new = parameters
        .get("newName")
        .and_then(Value::as_str)
        .ok_or(RequestError::Parameter("newName"))?
        .to_owned();
    let Some((modules, symbol, span)) = server.symbol(parameters)? else {
        return Err(RequestError::NoName);
    };
    let root = server.document(parameters)?.root.clone();
    let shared = server.shared_symbol(&root, &modules, symbol);
    if let Some(reason) = why_fixed(&shared, symbol) {
        return Err(reason.to_owned().into());
    }
    if let Some(reason) = why_no_name(&new) {
        return Err(format!("`{new}` {reason}").into());
    }
    let declared = modules.declarations(symbol);
    let old = declared.first().map(|span| modules.sources.text(*span).to_owned());
    let old = old.ok_or_else(|| "its declaration is not known".to_owned())?;
    // The place that was asked about may write an alias, which is a name of its own.
    if modules.sources.text(last_name(&modules.sources.get(span.source).text, span)) != old {
        return Err("this is another name for it: rename it in its import".to_owned().into());
    }
    shared.refuse_unread(&old)?;
    refuse_clashes(&shared, &old, &new)?;
    let packages = shared.packages.iter();
    let packages: Vec<_> =
        packages.map(|package| (package, server.places(&package.modules.sources))).collect();
    let spans = packages.iter().flat_map(|(package, places)| {
        let sources = places.sources;
        let spans = package.references().into_iter();
        let names = spans.map(|span| last_name(&sources.get(span.source).text, span));
        let old = names.filter(|name| sources.text(*name) == old);
        old.map(|name| (places, name)).collect::<Vec<_>>()
    });
    report::rename_json(&new, spans)
}

/// Fails where the new name would change what a place means.
fn refuse_clashes(shared: &SharedSymbol, old: &str, new: &str) -> Result<(), RequestError> {
    for package in &shared.packages {
        if let Some(taken) = name_taken_in(package, new) {
            return Err(format!("`{new}` is already declared in `{taken}`").into());
        }
        if let Some(place) = package.modules.divided_place(package.symbol) {
            let source = package.modules.sources.get(place.source);
            let line = source.text[..place.start as usize].matches('\n').count() + 1;
            let place = format!("{}:{line}", source.path);
            return Err(
                format!("under other conditions, `{old}` is something else in {place}").into()
            );
        }
    }
    Ok(())
}

/// Why a word cannot be the name of a declaration, as the end of a sentence that begins with it.
pub(super) fn why_no_name(word: &str) -> Option<&'static str> {
    if !is_word(word) || word == "_" {
        Some("is not a name in WGSL")
    } else if word.starts_with("__") {
        Some("begins with two underscores, which WGSL reserves")
    } else if is_keyword(word) || !is_path_name(word) {
        Some("is a word of WGSL or WESL")
    } else if naga::keywords::wgsl::RESERVED.contains(&word) {
        Some("is a reserved word of WGSL")
    } else if naga::keywords::wgsl::BUILTIN_IDENTIFIERS.contains(&word) || is_short_type(word) {
        Some("has a meaning in WGSL, which the new name would hide")
    } else {
        None
    }
}

/// Whether a word is the short name of a type, such as `vec4f` or `mat4x3h`.
fn is_short_type(word: &str) -> bool {
    let size = |text: &str| matches!(text, "2" | "3" | "4");
    let vector = word.strip_prefix("vec").and_then(|rest| rest.strip_suffix(['f', 'h', 'i', 'u']));
    let matrix = word.strip_prefix("mat").and_then(|rest| rest.strip_suffix(['f', 'h']));
    vector.is_some_and(size)
        || matrix.and_then(|rest| rest.split_once('x')).is_some_and(|(a, b)| size(a) && size(b))
}

/// A module that declares or uses the symbol and already has the new name.
fn name_taken_in(package: &PackageSymbol, new: &str) -> Option<String> {
    let modules = &package.modules;
    let name: Name = modules.graph.names.find(new)?;
    let places = package.references();
    let nodes = modules.graph.nodes.iter();
    let mut used = nodes.filter(|node| places.iter().any(|span| span.source == node.module.source));
    let has = |node: &&lamplight_compose::resolve::wesl::ModuleNode| {
        node.sets.contains_key(&name)
            || node.aliases.contains_key(&name)
            || node.module.items.iter().any(|item| item.locals.contains(&name))
    };
    used.find(has).map(|node| node.label.clone())
}

/// The protocol's `SymbolKind` of an item.
pub(super) fn symbol_kind(kind: ItemKind) -> u32 {
    match kind {
        ItemKind::Function => 12,
        ItemKind::Struct => 23,
        ItemKind::Const | ItemKind::Override => 14,
        ItemKind::Var => 13,
        ItemKind::Alias => 26,
        ItemKind::ConstAssert => 24,
    }
}

/// `textDocument/documentSymbol`.
pub fn document_symbols(
    server: &mut LanguageServer,
    parameters: &Value,
) -> Result<Value, RequestError> {
    if glsl::is_glsl(server, parameters) {
        return glsl::document_symbols(server, parameters);
    }
    let document = server.document(parameters)?;
    let (root, path) = (document.root.clone(), document.path.clone());
    let Some(modules) = server.modules(&root) else { return Ok(json!([])) };
    let Some(node) = modules.node(&path) else { return Ok(json!([])) };
    let module = &modules.graph.nodes[node as usize].module;
    let lines = Lines::new(&module.text);
    let range =
        |range: &std::ops::Range<u32>| lines.range(range.start as usize..range.end as usize);
    let symbols = module.items.iter().map(|item| {
        let name = match item.kind {
            ItemKind::ConstAssert => "const_assert",
            _ => modules.graph.names.text(item.name),
        };
        json!({
            "name": name,
            "kind": symbol_kind(item.kind),
            "range": range(&item.range),
            "selectionRange": range(&item.name_range),
        })
    });
    Ok(symbols.collect())
}

/// `workspace/symbol`: of the packages of all open documents, and of the library.
pub fn workspace_symbols(
    server: &mut LanguageServer,
    parameters: &Value,
) -> Result<Value, RequestError> {
    let query = parameters.get("query").and_then(Value::as_str).unwrap_or_default().to_lowercase();
    let roots: BTreeSet<_> = server.documents.values().map(|found| found.root.clone()).collect();
    let mut found = Vec::new();
    for root in roots {
        if let Some(whole) = server.whole(&root) {
            let most = SYMBOLS.saturating_sub(found.len());
            found.extend(glsl::workspace_symbols(server, &whole, &query, most));
        }
        let Some(modules) = server.modules(&root) else { continue };
        let places = server.places(&modules.sources);
        for node in &modules.graph.nodes {
            for item in node.module.items.iter().filter(|item| item.name != Name::UNDERSCORE) {
                let name = modules.graph.names.text(item.name);
                let span = node.module.span(item.name_range.clone());
                if found.len() < SYMBOLS && name.to_lowercase().contains(&query) {
                    let place = places.location(span);
                    found.extend(place.map(|location| {
                        json!({
                            "name": name,
                            "kind": symbol_kind(item.kind),
                            "containerName": node.label,
                            "location": location,
                        })
                    }));
                }
            }
        }
    }
    Ok(Value::Array(found))
}
