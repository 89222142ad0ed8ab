//! Names of GLSL: what they are, where they are declared, and what may be written.

mod complete;
mod names;
mod outline;
mod references;
mod rename;
mod tokens;
mod units;
mod words;

use crate::failure::RequestError;
use std::ops::Range;

use serde_json::{Value, json};

pub use complete::complete_at;
use names::{GlslNames, NameMeaning};
use outline::{GlslDeclaration, SymbolKind};
pub use references::{Whole, read_whole, references_at, signature_help, workspace_symbols};
pub use rename::{prepare_rename, rename_symbol};

use super::package::OpenedPackage;
use super::place::Lines;
use super::{LanguageServer, hover, navigate, report};
use lamplight_bundle::Language;
use lamplight_compose::project::LIBRARY;
use lamplight_compose::resolve::{Graph, ROOT, glsl};
use lamplight_diagnostic::source::Span;
use lamplight_lint as lint;
use lamplight_permute::axis::Axis;
use lamplight_syntax::wesl::ItemKind;

/// Lines of a declaration that are shown.
const SHOWN: usize = 40;

/// A file of GLSL with its names, in its package.
struct OpenGlslFile {
    opened: OpenedPackage,
    names: GlslNames,
    path: String,
}

/// Whether parameters name a document of GLSL.
pub fn is_glsl(server: &LanguageServer, parameters: &Value) -> bool {
    let document = server.document(parameters);
    document.is_ok_and(|document| lint::language(&document.path) == Some(Language::Glsl))
}

fn read_names(
    server: &LanguageServer,
    parameters: &Value,
) -> Result<Option<OpenGlslFile>, RequestError> {
    let document = server.document(parameters)?;
    let path = document.path.clone();
    let Some(mut opened) = server.opened(&document.root) else { return Ok(None) };
    let Ok(Graph::Glsl(graph)) = server.graph(&mut opened, &path) else { return Ok(None) };
    Ok(Some(OpenGlslFile { opened, names: GlslNames::new(graph), path }))
}

impl OpenGlslFile {
    fn package_of(&self, file: usize) -> Option<&str> {
        let number = Some(self.names.graph.packages[file]).filter(|number| *number != ROOT)?;
        Some(&self.opened.packages.package(number).name)
    }

    fn span(&self, file: usize, range: &Range<u32>) -> Span {
        let source = self.names.graph.modules[file].source;
        Span { source, start: range.start, end: range.end }
    }

    /// The description of a declaration that is an item of the library.
    fn library_item(&self, server: &mut LanguageServer, file: usize, name: &str) -> Option<String> {
        let path =
            self.names.graph.paths[file].strip_prefix("lamplight/")?.strip_suffix(".glsl")?;
        let path = path.replace('/', "::");
        let known = server.items();
        let module = known.iter().find(|module| module.path == path)?;
        let item = module.items.iter().find(|item| item.name == name)?;
        let code = item.glsl.as_deref()?;
        Some(hover::of_library(item, "glsl", code, &item.include()))
    }

    fn describe_declared(
        &self,
        server: &mut LanguageServer,
        found: &[(usize, &GlslDeclaration)],
    ) -> Option<String> {
        let (file, first) = found.first()?;
        if self.package_of(*file) == Some(LIBRARY) {
            let name = self.names.graph.symbols.text(first.name);
            if let Some(text) = self.library_item(server, *file, name) {
                return Some(text);
            }
        }
        let code: Vec<String> = found
            .iter()
            .map(|(file, declaration)| {
                let text = text_of(&self.names.graph.modules[*file], &declaration.range);
                text.lines().take(SHOWN).collect::<Vec<_>>().join("\n")
            })
            .collect();
        let comment = comment_above(&self.names.graph.modules[*file].text, first.range.start);
        let path = &self.names.graph.paths[*file];
        Some(format!("```glsl\n{}\n```\n{comment}\n\n`{path}`", code.join("\n")))
    }
}

fn text_of<'m>(module: &'m lamplight_syntax::glsl::Module, range: &Range<u32>) -> &'m str {
    module.text.get(range.start as usize..range.end as usize).unwrap_or_default()
}

/// The lines of comments right above a byte's line, without their marks.
fn comment_above(text: &str, byte: u32) -> String {
    let before = text.get(..byte as usize).unwrap_or_default();
    let before = &before[..before.rfind('\n').map_or(0, |end| end + 1)];
    let lines = before.lines().rev().take(SHOWN);
    let comments = lines.map_while(|line| line.trim().strip_prefix("//"));
    let mut found: Vec<&str> = comments.map(|line| line.trim_start_matches('/').trim()).collect();
    found.reverse();
    found.join("\n")
}

/// `textDocument/hover`.
pub fn hover_at(server: &mut LanguageServer, parameters: &Value) -> Result<Value, RequestError> {
    let (_, byte) = server.requested_place(parameters)?;
    let Some(requested) = read_names(server, parameters)? else { return Ok(Value::Null) };
    let Some((meaning, place)) = requested.names.meaning(byte as u32) else {
        return Ok(Value::Null);
    };
    let module = &requested.names.graph.modules[0];
    let text = match meaning {
        NameMeaning::Local(local) => {
            Some(format!("```glsl\n{}\n```", text_of(module, &local.range)))
        }
        NameMeaning::Declared(found) => requested.describe_declared(server, &found),
        NameMeaning::File(file) => Some(format!("`{}`", requested.names.graph.paths[file])),
        NameMeaning::Macro(name) => describe_macro(server, &requested, name),
    };
    let Some(text) = text else { return Ok(Value::Null) };
    Ok(report::hover_json(&text, &module.text, place.start as usize..place.end as usize))
}

/// The axis that a macro is, or that it names a value of.
fn describe_macro(server: &LanguageServer, requested: &OpenGlslFile, name: &str) -> Option<String> {
    let programs = requested.opened.manifest.iter().flat_map(|manifest| &manifest.programs);
    let mut axes = programs.flat_map(|program| program.space.axes());
    let axis = axes.find(|axis| is_macro_of(axis, name))?;
    Some(hover::describe_flag(server, &requested.opened, &requested.path, &axis.name))
}

/// Whether a macro stands for an axis or for one of its values.
fn is_macro_of(axis: &Axis, name: &str) -> bool {
    let own = axis.name.to_uppercase();
    let is_value =
        |rest: &str| axis.values.iter().any(|value| value.to_string().to_uppercase() == rest);
    let rest = name.strip_prefix(&own).map(|rest| rest.strip_prefix('_'));
    name == own || rest.flatten().is_some_and(is_value)
}

/// `textDocument/definition`.
pub fn definition_at(
    server: &mut LanguageServer,
    parameters: &Value,
) -> Result<Value, RequestError> {
    let (_, byte) = server.requested_place(parameters)?;
    let Some(requested) = read_names(server, parameters)? else { return Ok(Value::Null) };
    let Some((meaning, _)) = requested.names.meaning(byte as u32) else { return Ok(Value::Null) };
    let places: Vec<(usize, Range<u32>)> = match meaning {
        NameMeaning::Local(local) => vec![(0, local.place.clone())],
        NameMeaning::Declared(found) => {
            found.iter().map(|(file, declaration)| (*file, declaration.place.clone())).collect()
        }
        NameMeaning::File(file) => vec![(file, 0..0)],
        NameMeaning::Macro(_) => Vec::new(),
    };
    let texts = server.places(&requested.opened.sources);
    let spans = places.iter().map(|(file, place)| requested.span(*file, place));
    Ok(spans.filter_map(|span| texts.location(span)).collect())
}

/// `textDocument/documentSymbol`.
pub fn document_symbols(
    server: &mut LanguageServer,
    parameters: &Value,
) -> Result<Value, RequestError> {
    let Some(requested) = read_names(server, parameters)? else { return Ok(json!([])) };
    let lines = Lines::new(&requested.names.graph.modules[0].text);
    let range = |range: &Range<u32>| lines.range(range.start as usize..range.end as usize);
    let own = requested.names.outlines[0].declarations.iter();
    let symbols = own.filter(|found| found.kind != SymbolKind::Member).map(|found| {
        json!({
            "name": requested.names.graph.symbols.text(found.name),
            "kind": symbol_kind(found.kind),
            "range": range(&found.whole),
            "selectionRange": range(&found.place),
        })
    });
    Ok(symbols.collect())
}

/// The protocol's `SymbolKind` of a declaration, as for the same kind of item in WESL. Members are
/// not listed.
fn symbol_kind(kind: SymbolKind) -> u32 {
    navigate::symbol_kind(match kind {
        SymbolKind::Function => ItemKind::Function,
        SymbolKind::Struct => ItemKind::Struct,
        SymbolKind::Constant | SymbolKind::Macro => ItemKind::Const,
        SymbolKind::Variable | SymbolKind::Member => ItemKind::Var,
    })
}

/// How a file may be named in an `#include` of the root file.
fn path_spellings(requested: &OpenGlslFile, angled: bool) -> Vec<String> {
    glsl::include_spellings(&requested.opened.packages, &requested.path, angled)
}
