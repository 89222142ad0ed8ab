//! The functions of a package for three.js: a node of TSL for each, in WGSL and in GLSL.
//!
//! `compose -> Declarations -> chosen_functions -> translated_parts -> package_files`
//!
//! A text with every function is composed once, so that each declaration has one name in all modules.
//! What the exported functions reach of it is translated to GLSL as one text. Each declaration of the
//! two texts is then a *part*, which names the parts that it needs.

mod declarations;
mod glsl;
mod signature;
mod write;

use std::collections::{BTreeMap, BTreeSet};

use lamplight_bundle::Language;
use lamplight_compose::project::LIBRARY;
use lamplight_compose::resolve::{self, Packages};
use lamplight_compose::{Composed, Keep, Mangle, Options, compose};
use lamplight_diagnostic::Diagnostics;
use lamplight_diagnostic::source::{Files, ReadError, SourceId, SourceSet};
use lamplight_permute::Settings;

use crate::{CatalogueItem, CatalogueItemKind, CatalogueModule};
use declarations::Declarations;
pub use signature::Signature;

/// What is exported.
pub struct ThreePackage {
    /// Texts by path below the folder of the npm package.
    pub files: BTreeMap<String, String>,
    /// How many functions it has.
    pub functions: usize,
    /// What is not in it.
    pub left_out: Vec<LeftOut>,
}

/// A function that no node can be made of, or none for WebGL.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct LeftOut {
    /// The path of the function, `::` between its parts.
    pub path: String,
    pub reason: String,
}

/// Stands for texts that are no source of the author's.
const MADE: SourceId = SourceId(u32::MAX);

/// Problems of a text that is no author's: without their places.
fn without_places(mut problems: Diagnostics) -> Diagnostics {
    for problem in &mut problems {
        problem.labels.clear();
        problem.notes.push("in the text of all functions that are exported".to_owned());
    }
    problems
}

/// The file that uses all functions. No other has this name.
const ROOT: &str = "lamplight_three_export.wesl";

/// The files of a package, with one more.
struct WithRoot {
    below: Box<dyn Files>,
    text: String,
}

impl Files for WithRoot {
    fn read(&self, path: &str) -> Result<Option<String>, ReadError> {
        if path == ROOT { Ok(Some(self.text.clone())) } else { self.below.read(path) }
    }

    fn list(&self, extensions: &[&str]) -> Vec<String> {
        self.below.list(extensions)
    }

    fn display(&self, path: &str) -> String {
        self.below.display(path)
    }

    fn on_disk(&self, path: &str) -> bool {
        path != ROOT && self.below.on_disk(path)
    }
}

/// The npm package of the functions in `modules`, which are modules of the root of `packages`. Names
/// in shaders begin with `name`.
pub fn three_package(
    mut packages: Packages,
    modules: &[CatalogueModule],
    name: &str,
    settings: &Settings,
    sources: &mut SourceSet,
) -> Result<ThreePackage, Diagnostics> {
    let functions: Vec<&CatalogueItem> = modules
        .iter()
        .flat_map(|module| &module.items)
        .filter(|item| item.kind == CatalogueItemKind::Function)
        .collect();
    let homes = homes_of(&*packages.root.files);
    packages.root.files =
        Box::new(WithRoot { below: packages.root.files, text: root_text(&functions) });
    let graph = resolve::load(sources, &packages, ROOT, Language::Wesl)?;
    let options = Options { mangle: Mangle::Underscore, keep: Keep::Root, stage: None };
    let composed = compose(&graph, settings, &options)?;
    let declarations = Declarations::of(&composed, sources, &homes, name);
    let (exported, mut left_out) = chosen_functions(&composed, &functions, &declarations);
    let made = glsl::translated_parts(&declarations, exported, &mut left_out)?;
    left_out.sort();
    let files = write::package_files(&made, modules, name, &left_out);
    Ok(ThreePackage { files, functions: made.exported.len(), left_out })
}

/// The module of each file, by the path that is shown of it.
fn homes_of(files: &dyn Files) -> BTreeMap<String, String> {
    let paths = files.list(&["wesl", "wgsl"]).into_iter();
    let home = |path: String| {
        let (stem, _) = path.rsplit_once('.')?;
        Some((files.display(&path), stem.to_owned()))
    };
    paths.filter_map(home).collect()
}

/// A module that names each function once, in their order.
fn root_text(functions: &[&CatalogueItem]) -> String {
    let (mut imports, mut uses) = (String::new(), String::new());
    for (index, item) in functions.iter().enumerate() {
        imports +=
            &format!("import package::{}::{} as lamplight_{index};\n", item.module, item.name);
        uses += &format!("    _ = lamplight_{index};\n");
    }
    format!("{imports}\nfn lamplight_three_export() {{\n{uses}}}\n")
}

/// An exported function: its place in the list of declarations, and what it takes and gives.
#[derive(Debug, Clone)]
struct Exported<'a> {
    item: &'a CatalogueItem,
    declaration: usize,
    /// Its name in shaders.
    name: String,
    signature: Signature,
}

/// The path of a function as people write it.
fn path_of(item: &CatalogueItem) -> String {
    if item.package == LIBRARY { item.path() } else { format!("{}::{}", item.module, item.name) }
}

/// The functions of which nodes can be made.
fn chosen_functions<'a>(
    composed: &Composed,
    functions: &[&'a CatalogueItem],
    declarations: &Declarations,
) -> (Vec<Exported<'a>>, Vec<LeftOut>) {
    let (mut exported, mut left_out) = (Vec::new(), Vec::new());
    let mut taken = BTreeSet::new();
    for (item, composed_name) in functions.iter().zip(names_in_root(composed)) {
        let Some(declaration) = declarations.find(composed_name) else { continue };
        if !taken.insert(declaration) {
            continue;
        }
        match declarations.signature(declaration) {
            Ok(signature) => {
                let name = declarations.all[declaration].name.clone();
                exported.push(Exported { item, declaration, name, signature });
            }
            Err(reason) => left_out.push(LeftOut { path: path_of(item), reason }),
        }
    }
    (exported, left_out)
}

/// The names that the functions have in the composed text: the root names them in their order.
fn names_in_root(composed: &Composed) -> impl Iterator<Item = &str> {
    let root = composed.function("lamplight_three_export");
    let body = root.and_then(|part| composed.text.get(part.range.clone())).unwrap_or_default();
    body.lines().filter_map(|line| line.trim().strip_prefix("_ = ")?.strip_suffix(';'))
}
