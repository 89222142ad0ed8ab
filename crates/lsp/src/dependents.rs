//! A symbol in every package of the workspace that may name it: the one that declares it, and those
//! that depend on that one.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::LanguageServer;
use super::failure::RequestError;
use super::package::{OpenedPackage, PackageModules, WeslSymbol};
use super::place::{Lines, path_of_address};
use super::places::address_of;
use lamplight_compose::resolve::wesl::ModuleNode;
use lamplight_diagnostic::Diagnostic;
use lamplight_diagnostic::source::{Disk, Files, SourceId, Span};
use lamplight_syntax::words::has_word;

/// A symbol as one package knows it.
pub struct PackageSymbol {
    pub modules: Arc<PackageModules>,
    pub symbol: WeslSymbol,
    /// Whether files of other packages are left to these.
    is_own_only: bool,
}

impl PackageSymbol {
    /// Every place that names the symbol.
    pub fn references(&self) -> Vec<Span> {
        let mut found = self.modules.references(self.symbol);
        found.retain(|span| !self.is_own_only || self.modules.graph.is_own(span.source));
        found
    }
}

/// A symbol in the packages that name it.
pub struct SharedSymbol {
    /// The package that declares it first, if that is one of the workspace.
    pub packages: Vec<PackageSymbol>,
    /// Whether the workspace has the package that declares it.
    pub is_at_home: bool,
    /// Files that may name it and cannot be read in full, each with a reason.
    pub unread: Vec<String>,
}

/// Packages that depend on another one.
pub struct Dependents {
    /// Root folders.
    pub roots: Vec<PathBuf>,
    /// Why more packages may depend on it.
    pub unread: Vec<String>,
}

impl LanguageServer {
    /// The symbol of a package, in all packages of the workspace that may name it.
    pub fn shared_symbol(
        &mut self,
        root: &Path,
        modules: &Arc<PackageModules>,
        symbol: WeslSymbol,
    ) -> SharedSymbol {
        let alone = |is_at_home| SharedSymbol {
            packages: vec![PackageSymbol {
                modules: Arc::clone(modules),
                symbol,
                is_own_only: false,
            }],
            is_at_home,
            unread: Vec::new(),
        };
        let WeslSymbol::Items { node, name } = symbol else { return alone(true) };
        let node = &modules.graph.nodes[node as usize];
        let name = modules.graph.names.text(name).to_owned();
        let (package, source) = (node.package, node.module.source);
        let Some(file) = self.file_of(modules, source) else { return alone(package == 0) };
        let home = if package == 0 { root.to_owned() } else { super::package_of_file(&file).0 };
        let mut found =
            SharedSymbol { packages: Vec::new(), is_at_home: false, unread: Vec::new() };
        if package == 0 || self.is_of_workspace(&home) {
            found.is_at_home = self.add_package(&home, &file, &name, &mut found.packages);
        }
        if !found.is_at_home {
            found = alone(false);
        }
        let dependents = self.dependents(&home, &name);
        found.unread = dependents.unread;
        for dependent in dependents.roots {
            self.add_package(&dependent, &file, &name, &mut found.packages);
        }
        found
    }

    /// Adds the symbol as a package knows it, if it reads the file. Returns whether it does.
    fn add_package(
        &mut self,
        root: &Path,
        file: &Path,
        name: &str,
        packages: &mut Vec<PackageSymbol>,
    ) -> bool {
        let Some(modules) = self.modules(root) else { return false };
        let nodes = modules.graph.nodes.iter();
        let mut files = nodes.map(|node| self.file_of(&modules, node.module.source));
        let node = files.position(|known| known.as_deref() == Some(file));
        let (Some(node), Some(name)) = (node, modules.graph.names.find(name)) else { return false };
        let symbol = WeslSymbol::Items { node: node as u32, name };
        packages.push(PackageSymbol { modules, symbol, is_own_only: true });
        true
    }

    /// The file of a text that is read from the disk, or is open.
    fn file_of(&self, modules: &PackageModules, source: SourceId) -> Option<PathBuf> {
        let source_set = &modules.sources;
        if !source_set.get(source).on_disk {
            return None;
        }
        path_of_address(&address_of(source_set, source, &*self.library)?)
    }

    /// Whether a package is in a folder of the editor, or has an open file.
    pub fn is_of_workspace(&self, root: &Path) -> bool {
        self.documents.values().any(|document| document.root == root)
            || self.workspace.packages().roots.contains(root)
    }

    /// The packages of the workspace that depend on the one with this root, directly or through
    /// others. Those that cannot be opened are listed if one of their files has the name.
    pub fn dependents(&self, home: &Path, name: &str) -> Dependents {
        let mut packages = self.workspace.packages();
        packages.roots.extend(self.documents.values().map(|document| document.root.clone()));
        packages.roots.remove(home);
        let mut found = Dependents { roots: Vec::new(), unread: Vec::new() };
        if packages.is_cut {
            found.unread.push("the workspace has more folders than are searched".to_owned());
        }
        for root in packages.roots {
            match self.open_package(&root) {
                Ok(opened) if depends_on(&opened, home) => found.roots.push(root),
                Ok(_) => {}
                Err((sources, problems)) => {
                    let Some(file) = self.file_with(&root, name) else { continue };
                    let label = problems.first().and_then(|problem| problem.labels.first());
                    let manifest = label.map(|label| sources.get(label.span.source).path.clone());
                    let manifest = manifest.unwrap_or_else(|| root.display().to_string());
                    found.unread.push(format!(
                        "`{manifest}` has errors, and `{file}` of its package has this name"
                    ));
                }
            }
        }
        found
    }

    /// A module of a package that cannot be opened, if it has a word.
    fn file_with(&self, root: &Path, word: &str) -> Option<String> {
        let files = Disk::new(root).ok()?;
        let has = |path: &String| {
            files.read(path).ok().flatten().is_some_and(|text| has_word(&text, word))
        };
        files.list(lamplight_lint::EXTENSIONS).into_iter().find(has)
    }
}

/// Whether a package may import one with this root folder.
fn depends_on(opened: &OpenedPackage, home: &Path) -> bool {
    opened.packages.all().skip(1).any(|package| {
        let folder = package.files.display("");
        package.files.on_disk("")
            && Path::new(&folder).canonicalize().is_ok_and(|real| real == home)
    })
}

impl SharedSymbol {
    /// Fails where a file that may name the symbol cannot be read in full, so that an edit of all
    /// places could miss some.
    pub fn refuse_unread(&self, name: &str) -> Result<(), RequestError> {
        if let Some(reason) = self.unread.first() {
            return Err(format!("uses may be missed: {reason}").into());
        }
        for package in &self.packages {
            let modules = &package.modules;
            for (index, node) in modules.graph.nodes.iter().enumerate() {
                let is_own = node.package == 0 && has_word(&node.module.text, name);
                let errors = node.module.errors.iter().filter(|_| is_own);
                let hidden = errors.into_iter().find(|error| {
                    let byte = error.labels.first().map(|label| label.span.start);
                    may_hide(package.symbol, index, node, byte)
                });
                if let Some(error) = hidden {
                    return Err(fix_first(modules, node, error).into());
                }
            }
        }
        Ok(())
    }
}

/// Whether an error of syntax at a byte may hide uses of a symbol. A local is used only in the item
/// that has it.
fn may_hide(symbol: WeslSymbol, index: usize, node: &ModuleNode, byte: Option<u32>) -> bool {
    let WeslSymbol::Local { node: own, declared } = symbol else { return true };
    let item = node.module.items.iter().find(|item| item.range.contains(&declared));
    own as usize == index && item.zip(byte).is_none_or(|(item, byte)| item.range.contains(&byte))
}

fn fix_first(modules: &PackageModules, node: &ModuleNode, error: &Diagnostic) -> String {
    let byte = error.labels.first().map_or(0, |label| label.span.start);
    let (line, _) = Lines::new(&node.module.text).units(byte as usize);
    let file = &modules.sources.get(node.module.source).path;
    format!("uses may be missed, fix this first: `{file}:{}`: {}", line + 1, error.message)
}
