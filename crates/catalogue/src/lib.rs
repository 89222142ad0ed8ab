//! What the shader library offers: its modules, plots, presets and light probes, and the pages
//! that show them.
//!
//! Everything is read from the library's own files: names, signatures and documentation from the
//! modules, [`plot`]s from `NAME.plot.toml` and [`figure`]s from `NAME.figure.toml` beside a
//! module, [`preset`]s from `presets.toml`, [`probe`]s from `data/sh9_probes.toml`, recorded
//! [`cost`]s from `costs.toml`. [`pages`] writes the catalogue from them.

pub mod cost;
pub mod figure;
mod natural;
mod outline;
pub mod pages;
pub mod plot;
pub mod prefix;
pub mod preset;
pub mod probe;
pub mod quality;
pub mod reader;
pub mod three;
pub mod translated;

use lamplight_compose::project::LIBRARY;
use lamplight_diagnostic::Diagnostics;
use lamplight_diagnostic::source::{Embedded, Files, SourceSet};
use lamplight_permute::Manifest;

/// The folder of the library that holds programs, which are not modules.
const PROGRAMS: &str = "programs/";

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CatalogueItemKind {
    Function,
    Struct,
    Constant,
}

impl CatalogueItemKind {
    /// One word.
    pub fn name(self) -> &'static str {
        match self {
            Self::Function => "function",
            Self::Struct => "struct",
            Self::Constant => "constant",
        }
    }
}

/// A parameter of a function or a field of a struct.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CatalogueMember {
    pub name: String,
    /// Type in WESL.
    pub ty: String,
    /// Its meaning, range and unit; empty if it is not documented.
    pub doc: String,
}

/// A public function, struct or constant of a module.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CatalogueItem {
    pub kind: CatalogueItemKind,
    /// The package by the name that imports it.
    pub package: String,
    /// Module path below the package, `::` between its parts.
    pub module: String,
    pub name: String,
    /// The lines of the doc comment, without comment marks.
    pub doc: Vec<String>,
    /// Declaration in WESL, without its body.
    pub wesl: String,
    /// Declaration in GLSL, without its body; `None` where the twin lacks it.
    pub glsl: Option<String>,
    /// Parameters or fields, in order.
    pub members: Vec<CatalogueMember>,
    /// Type of a function's result in WESL.
    pub result: Option<String>,
}

impl CatalogueItem {
    /// The path below the library, such as `lighting::spot::cone_hard`. In any other package it
    /// begins with the package.
    pub fn path(&self) -> String {
        in_package(&self.package, &format!("{}::{}", self.module, self.name))
    }

    /// Path with the package.
    pub fn full_path(&self) -> String {
        format!("{}::{}::{}", self.package, self.module, self.name)
    }

    /// The first line of the documentation.
    pub fn summary(&self) -> &str {
        self.doc.iter().map(String::as_str).find(|line| !line.is_empty()).unwrap_or_default()
    }

    /// The paragraphs before the first section.
    pub fn paragraphs(&self) -> Vec<String> {
        let lines: Vec<String> =
            self.doc.iter().take_while(|line| !is_heading(line)).cloned().collect();
        joined_paragraphs(&lines)
    }

    /// The text under the heading `NAME:`, without the heading.
    pub fn section(&self, name: &str) -> Option<String> {
        let start = self
            .doc
            .iter()
            .position(|line| line.strip_prefix(name).is_some_and(|rest| rest.starts_with(':')))?;
        let rest =
            self.doc[start + 1..].iter().take_while(|line| !line.is_empty() && !is_heading(line));
        let first = self.doc[start][name.len() + 1..].trim();
        let lines: Vec<&str> = std::iter::once(first).chain(rest.map(|line| line.trim())).collect();
        let text = lines.join(" ").trim().to_owned();
        let is_edges =
            name == EDGES && self.kind == CatalogueItemKind::Function && self.package == LIBRARY;
        Some(if is_edges && !text.contains("NaN") { format!("{text} {NAN}") } else { text })
    }

    /// What to write in WESL to use it.
    pub fn import(&self) -> String {
        format!("import {};", self.full_path())
    }

    /// What to write in GLSL to use it.
    pub fn include(&self) -> String {
        let file = format!("{}.glsl", self.module.replace("::", "/"));
        if self.package == LIBRARY {
            format!("#include <{LIBRARY}/{file}>")
        } else {
            format!("#include \"{file}\"")
        }
    }
}

/// The headings of a doc comment, in their order.
pub const SECTIONS: &[&str] = &["Parameters", "Returns", "Source", "Edges", "Error model"];

/// The heading of what a function gives for arguments that have no meaning.
const EDGES: &str = "Edges";

/// What is true of every function of the library whose comment says nothing about NaN. WGSL,
/// section "Floating Point Evaluation": an implementation may assume that no value is NaN.
const NAN: &str = "Where an argument is NaN, the result is indeterminate.";

fn is_heading(line: &str) -> bool {
    SECTIONS
        .iter()
        .any(|section| line.strip_prefix(section).is_some_and(|rest| rest.starts_with(':')))
}

/// Lines joined where no blank one is between them.
fn joined_paragraphs(lines: &[String]) -> Vec<String> {
    let blocks = lines.split(|line| line.is_empty()).filter(|block| !block.is_empty());
    blocks.map(|block| block.iter().map(|line| line.trim()).collect::<Vec<_>>().join(" ")).collect()
}

/// A path, with its package unless that is the library.
fn in_package(package: &str, path: &str) -> String {
    if package == LIBRARY { path.to_owned() } else { format!("{package}::{path}") }
}

/// A module of the library or of the user's own package.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CatalogueModule {
    /// The path below the library, with `::` between its parts. In any other package it begins with
    /// the package.
    pub path: String,
    /// The package by the name that imports it.
    pub package: String,
    /// Paragraphs of the module's own comment.
    pub doc: Vec<String>,
    pub items: Vec<CatalogueItem>,
}

impl CatalogueModule {
    /// The first sentence of the module's comment.
    pub fn summary(&self) -> &str {
        let first = self.doc.first().map_or("", String::as_str);
        first.split_inclusive(". ").next().unwrap_or_default().trim_end()
    }

    /// How many items of a kind it has.
    pub fn count(&self, kind: CatalogueItemKind) -> usize {
        self.items.iter().filter(|item| item.kind == kind).count()
    }
}

/// Every module of the library, by path.
pub fn library_modules(library: Embedded) -> Vec<CatalogueModule> {
    package_modules(&library)
}

/// The library's presets and light probes, each by name.
pub fn library_examples(
    library: Embedded,
    sources: &mut SourceSet,
    manifest: &Manifest,
) -> Result<(Vec<preset::Preset>, Vec<probe::Probe>), Diagnostics> {
    let probes = probe::library_probes(library, sources)?;
    Ok((preset::library_presets(library, sources, manifest, &probes)?, probes))
}

/// Every module of a package that has the library's layout.
pub fn package_modules(files: &dyn Files) -> Vec<CatalogueModule> {
    let paths = files.list(&["wesl"]).into_iter().filter(|path| !path.starts_with(PROGRAMS));
    paths
        .filter_map(|path| read_module(files, LIBRARY, path.strip_suffix(".wesl")?, ".wesl"))
        .collect()
}

/// Every module of the user's own package, even if it is not documented.
pub fn own_modules(files: &dyn Files) -> Vec<CatalogueModule> {
    let paths = files.list(&["wesl", "wgsl"]).into_iter();
    let of = |path: String| {
        let ending = if path.ends_with(".wesl") { ".wesl" } else { ".wgsl" };
        read_module(files, OWN, path.strip_suffix(ending)?, ending)
    };
    paths.filter_map(of).collect()
}

/// The name of the user's own package in imports.
const OWN: &str = "package";

fn read_module(
    files: &dyn Files,
    package: &str,
    stem: &str,
    ending: &str,
) -> Option<CatalogueModule> {
    let text = files.read(&format!("{stem}{ending}")).ok()??;
    let twin = files.read(&format!("{stem}.glsl")).ok().flatten().unwrap_or_default();
    let path = stem.replace('/', "::");
    let glsl = outline::glsl_declarations(&twin);
    let declared = outline::wesl_declarations(&text).into_iter();
    // What the library does not document is not for its users.
    let declared = declared.filter(|found| package != LIBRARY || !found.doc.is_empty());
    let items = declared.map(|found| make_item(package, &path, found, &glsl)).collect();
    let doc = joined_paragraphs(&outline::module_doc(&text));
    Some(CatalogueModule {
        doc,
        items,
        path: in_package(package, &path),
        package: package.to_owned(),
    })
}

fn make_item(
    package: &str,
    module: &str,
    found: outline::CatalogueDeclaration,
    glsl: &[outline::CatalogueDeclaration],
) -> CatalogueItem {
    let twin = glsl.iter().find(|twin| twin.name == found.name && twin.kind == found.kind);
    let mut item = CatalogueItem {
        kind: found.kind,
        package: package.to_owned(),
        module: module.to_owned(),
        glsl: twin.map(|twin| twin.declaration.clone()),
        name: found.name,
        doc: found.doc,
        wesl: found.declaration,
        members: found.members,
        result: found.result,
    };
    describe_parameters(&mut item);
    item
}

/// Gives each parameter its text from the section `Parameters`.
fn describe_parameters(item: &mut CatalogueItem) {
    let Some(section) = item.section(SECTIONS[0]) else { return };
    let mut entries: Vec<String> = Vec::new();
    for piece in section.trim_end_matches('.').split("; ") {
        match entries.last_mut() {
            // A description may have a semicolon itself. Each begins with its names.
            Some(entry) if !piece.starts_with('`') => *entry += &format!("; {piece}"),
            _ => entries.push(piece.to_owned()),
        }
    }
    for entry in &entries {
        let (names, words) = split_description(entry);
        for member in item.members.iter_mut().filter(|member| names.contains(&member.name)) {
            member.doc = words.clone();
        }
    }
}

/// The names in backticks at the start of an entry, and the text about them.
fn split_description(entry: &str) -> (Vec<String>, String) {
    let (mut names, mut rest) = (Vec::new(), entry.trim());
    while let Some((name, after)) = rest.strip_prefix('`').and_then(|rest| rest.split_once('`')) {
        names.push(name.to_owned());
        let next = after.trim_start().trim_start_matches(',').trim_start();
        let next = next.strip_prefix("and ").filter(|next| next.starts_with('`')).unwrap_or(next);
        rest = next;
    }
    (names, rest.to_owned())
}
