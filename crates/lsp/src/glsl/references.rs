//! References, symbols and signatures in the GLSL files of a package.

use crate::failure::RequestError;
use std::collections::BTreeSet;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use serde_json::{Value, json};

use super::names::NameMeaning;
use super::outline::{GlslDeclaration, SymbolKind};
use super::units::{Meant, NamePlace, Units};
use super::{read_names, symbol_kind, text_of};
use crate::package::OpenedPackage;
use crate::{LanguageServer, hover};
use lamplight_catalogue as catalogue;
use lamplight_compose::project::LIBRARY;
use lamplight_compose::resolve::{ROOT, glsl};
use lamplight_diagnostic::source::Span;
use lamplight_syntax::glsl::Symbol;

/// Extensions of the files that are read even if no file includes them.
const EXTENSIONS: &[&str] = &["glsl", "vert", "frag", "comp"];

/// The most places in an answer.
pub const PLACES: usize = 10_000;

/// A package with all of its GLSL files.
pub struct Whole {
    pub opened: OpenedPackage,
    pub units: Units,
}

/// Reads all GLSL files of an opened package.
pub fn read_whole(mut opened: OpenedPackage) -> Option<Whole> {
    let paths = opened.packages.root.files.list(EXTENSIONS);
    let graph = glsl::load_all(&mut opened.sources, &opened.packages, &paths).ok()?;
    Some(Whole { opened, units: Units::new(graph) })
}

/// The symbol that a request is about, in its file.
pub struct RequestedSymbol {
    /// The root folder of the package.
    pub root: PathBuf,
    pub whole: Arc<Whole>,
    pub file: usize,
    pub meant: Meant,
    /// The name that stands there.
    pub range: Range<u32>,
}

/// The symbol at the position that the parameters name.
pub fn requested_symbol(
    server: &mut LanguageServer,
    parameters: &Value,
) -> Result<Option<RequestedSymbol>, RequestError> {
    let (document, byte) = server.requested_place(parameters)?;
    let (root, path) = (document.root.clone(), document.path.clone());
    let Some(whole) = server.whole(&root) else { return Ok(None) };
    let Some(file) = whole.file(&path) else { return Ok(None) };
    let found = whole.units.meant(file, byte as u32);
    Ok(found.map(|(meant, range)| RequestedSymbol { root, whole, file, meant, range }))
}

impl Whole {
    /// The file at a path of the package.
    pub fn file(&self, path: &str) -> Option<usize> {
        let shown = self.opened.packages.root.files.display(path);
        let paths = &self.units.names.graph.paths;
        (0..paths.len()).find(|file| self.units.is_own(*file) && paths[*file] == shown)
    }

    /// The path of a file on the disk.
    fn real_file(&self, file: usize) -> Option<PathBuf> {
        Path::new(&self.units.names.graph.paths[file]).canonicalize().ok()
    }

    /// The locations of places, those that have one.
    fn locations<'p>(
        &self,
        server: &LanguageServer,
        places: impl Iterator<Item = &'p NamePlace>,
    ) -> Vec<Value> {
        let texts = server.places(&self.opened.sources);
        places.filter_map(|place| texts.location(self.span(place))).collect()
    }

    pub fn span(&self, place: &NamePlace) -> Span {
        let source = self.units.module(place.file).source;
        Span { source, start: place.start, end: place.end }
    }

    fn is_of_library(&self, file: usize) -> bool {
        let number = self.units.names.graph.packages[file];
        number != ROOT && self.opened.packages.package(number).name == LIBRARY
    }
}

/// `textDocument/references`.
pub fn references_at(
    server: &mut LanguageServer,
    parameters: &Value,
) -> Result<Value, RequestError> {
    let declared = parameters.pointer("/context/includeDeclaration").and_then(Value::as_bool);
    if let Some(found) = including_places(server, parameters)? {
        return Ok(found);
    }
    let Some(requested) = requested_symbol(server, parameters)? else { return Ok(json!([])) };
    let (all, declarations) = requested.whole.units.places(&requested.meant, requested.file);
    let places =
        all.iter().filter(|place| declared != Some(false) || !declarations.contains(place));
    let mut found = requested.whole.locations(server, places.take(PLACES));
    let (dependents, _) = places_of_dependents(server, &requested, &declarations);
    for (whole, places) in dependents {
        found.extend(whole.locations(server, places.iter().take(PLACES)));
    }
    Ok(Value::Array(found))
}

/// Packages with their places that name a symbol.
type DependentPlaces = Vec<(Arc<Whole>, Vec<NamePlace>)>;

/// Where other packages of the workspace name a symbol that files of this one declare, and which of
/// them cannot be read.
pub fn places_of_dependents(
    server: &mut LanguageServer,
    requested: &RequestedSymbol,
    declared: &[NamePlace],
) -> (DependentPlaces, Vec<String>) {
    let units = &requested.whole.units;
    let (name, of_name): (_, fn(Symbol) -> Meant) = match &requested.meant {
        Meant::Local(..) => return (Vec::new(), Vec::new()),
        Meant::Member(name) => (*name, Meant::Member),
        Meant::Global(name) => (*name, Meant::Global),
    };
    let own = declared.iter().filter(|place| units.is_own(place.file));
    let files: BTreeSet<PathBuf> =
        own.filter_map(|place| requested.whole.real_file(place.file)).collect();
    if files.is_empty() {
        return (Vec::new(), Vec::new());
    }
    let dependents = server.dependents(&requested.root, units.spelt(name));
    let mut found = Vec::new();
    for root in dependents.roots {
        let Some(whole) = server.whole(&root) else { continue };
        let graph = &whole.units.names.graph;
        let Some(name) = graph.symbols.find(units.spelt(name)) else { continue };
        let is_declaring =
            |file: &usize| whole.real_file(*file).is_some_and(|file| files.contains(&file));
        let Some(file) = (0..graph.paths.len()).find(is_declaring) else { continue };
        let (mut places, _) = whole.units.places(&of_name(name), file);
        places.retain(|place| whole.units.is_own(place.file));
        if !places.is_empty() {
            found.push((whole, places));
        }
    }
    (found, dependents.unread)
}

/// If an `#include` is at the position, all places that include the same file.
fn including_places(
    server: &mut LanguageServer,
    parameters: &Value,
) -> Result<Option<Value>, RequestError> {
    let (document, byte) = server.requested_place(parameters)?;
    let (root, path) = (document.root.clone(), document.path.clone());
    let Some(whole) = server.whole(&root) else { return Ok(None) };
    let Some(file) = whole.file(&path) else { return Ok(None) };
    let Some(included) = whole.units.included_at(file, byte as u32) else { return Ok(None) };
    let places = whole.units.includes_of(included);
    Ok(Some(Value::Array(whole.locations(server, places.iter()))))
}

/// At most `most` names of all files that contain the query, for `workspace/symbol`.
pub fn workspace_symbols(
    server: &LanguageServer,
    whole: &Whole,
    query: &str,
    most: usize,
) -> Vec<Value> {
    let mut found = Vec::new();
    let places = server.places(&whole.opened.sources);
    let units = &whole.units;
    for (file, outline) in units.names.outlines.iter().enumerate() {
        // The library's macros guard its files and give its names their prefix.
        let is_library = whole.is_of_library(file);
        let shown = outline.declarations.iter().filter(|known| {
            known.kind != SymbolKind::Member && !(is_library && known.kind == SymbolKind::Macro)
        });
        for declaration in shown {
            let name = units.spelt(declaration.name);
            if is_guard(units, file, declaration) {
                continue;
            }
            if found.len() >= most || !name.to_lowercase().contains(query) {
                continue;
            }
            let Range { start, end } = declaration.place;
            let location = places.location(whole.span(&NamePlace { file, start, end }));
            found.extend(location.map(|location| {
                json!({
                    "name": name,
                    "kind": symbol_kind(declaration.kind),
                    "containerName": units.names.graph.paths[file],
                    "location": location,
                })
            }));
        }
    }
    found
}

/// Whether a macro has an empty body: it is an include guard.
fn is_guard(units: &Units, file: usize, declaration: &GlslDeclaration) -> bool {
    let behind = declaration.place.end..declaration.range.end;
    declaration.kind == SymbolKind::Macro && text_of(units.module(file), &behind).trim().is_empty()
}

/// `textDocument/signatureHelp`: every form of the function or macro that is called.
pub fn signature_help(
    server: &mut LanguageServer,
    parameters: &Value,
) -> Result<Value, RequestError> {
    let (document, byte) = server.requested_place(parameters)?;
    let Some((name, argument)) = hover::call_around(&document.text, byte) else {
        return Ok(Value::Null);
    };
    let word = document.text[name.clone()].to_owned();
    let Some(requested) = read_names(server, parameters)? else { return Ok(Value::Null) };
    let mut labels = match requested.names.meaning(name.start as u32) {
        Some((NameMeaning::Declared(found), _)) => {
            let label = |(file, declaration): &(usize, &GlslDeclaration)| {
                called_as(&requested.names.graph.modules[*file], declaration, &word)
            };
            found.iter().filter_map(label).collect()
        }
        _ => Vec::new(),
    };
    if labels.is_empty() {
        let known: Arc<Vec<catalogue::CatalogueModule>> = server.items();
        let mut items = known.iter().flat_map(|module| &module.items);
        labels.extend(items.find(|item| item.name == word).and_then(|item| item.glsl.clone()));
    }
    if labels.is_empty() {
        return Ok(Value::Null);
    }
    Ok(signatures_json(&labels, argument))
}

/// How a function, a macro or a struct is called, on one line.
fn called_as(
    module: &lamplight_syntax::glsl::Module,
    declaration: &GlslDeclaration,
    name: &str,
) -> Option<String> {
    let text = match declaration.kind {
        SymbolKind::Function => text_of(module, &declaration.range),
        SymbolKind::Macro => {
            let text = text_of(module, &(declaration.place.start..declaration.range.end));
            &text[..=text.find(')').filter(|_| text[name.len()..].starts_with('('))?]
        }
        SymbolKind::Struct => {
            let text = text_of(module, &declaration.range);
            let members = text.split_once('{')?.1.trim_end().trim_end_matches('}');
            let members: Vec<&str> = members.split(';').map(str::trim).collect();
            let members = members.join(", ");
            return Some(on_one_line(&format!("{name}({})", members.trim_end_matches([',', ' ']))));
        }
        SymbolKind::Constant | SymbolKind::Variable | SymbolKind::Member => return None,
    };
    Some(on_one_line(text))
}

fn on_one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// All forms, of which the first that has so many parameters is active.
fn signatures_json(labels: &[String], argument: usize) -> Value {
    let parts = |label: &str| -> Vec<String> {
        let list = label.split_once('(').and_then(|(_, rest)| Some(rest.rsplit_once(')')?.0));
        let parts = list.into_iter().flat_map(|list| list.split(','));
        parts.map(|part| part.trim().to_owned()).collect()
    };
    let fits = |label: &String| parts(label).len() > argument;
    let active = labels.iter().position(fits).unwrap_or(0);
    let signatures = labels.iter().map(|label| {
        let parts = parts(label).into_iter().map(|part| json!({ "label": part }));
        json!({ "label": label, "parameters": parts.collect::<Vec<_>>() })
    });
    json!({
        "signatures": signatures.collect::<Vec<_>>(),
        "activeSignature": active,
        "activeParameter": argument,
    })
}
