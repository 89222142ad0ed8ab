//! All modules of a package as one graph, and the symbol at a position in it.

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::declared::DeclaredPackages;
use super::file_cache::FileCache;
use lamplight_compose::project;
use lamplight_compose::resolve::Packages;
use lamplight_compose::resolve::wesl::{Graph, KeptModules, ModuleNode, PathTarget, load_all};
use lamplight_diagnostic::Diagnostics;
use lamplight_diagnostic::source::{Embedded, Files, Package, ReadError, SourceSet, Span};
use lamplight_permute::Manifest;
use lamplight_permute::manifest::Features;
use lamplight_syntax::wesl::{ComparisonOperand, Event, Expression, Item, Name};

/// Texts of open documents by their path below a package's root.
pub type OpenTexts = Arc<BTreeMap<String, String>>;

/// The files of a package, with the texts of open documents in place of the files on disk.
struct EditorFiles {
    root: PathBuf,
    below: Box<dyn Files>,
    open: OpenTexts,
    file_cache: Arc<FileCache>,
}

impl Files for EditorFiles {
    fn read(&self, path: &str) -> Result<Option<String>, ReadError> {
        match self.open.get(path) {
            Some(text) => Ok(Some(text.clone())),
            None if self.below.on_disk(path) => {
                let file = PathBuf::from(self.below.display(path));
                self.file_cache.or_read(&file, || self.below.read(path))
            }
            None => self.below.read(path),
        }
    }

    fn list(&self, extensions: &[&str]) -> Vec<String> {
        let mut found = match self.below.on_disk("") {
            true => {
                let list = || self.below.list(extensions);
                self.file_cache.or_list(self.below.display(""), extensions, list)
            }
            false => self.below.list(extensions),
        };
        let is_new = |path: &&String| {
            let ending = path.rsplit_once('.').map_or("", |(_, ending)| ending);
            extensions.contains(&ending) && !found.contains(path)
        };
        let new: Vec<String> = self.open.keys().filter(is_new).cloned().collect();
        found.extend(new);
        found.sort();
        found
    }

    // An open file has an address in the editor, whether or not it was ever saved.
    fn display(&self, path: &str) -> String {
        match self.open.contains_key(path) {
            true => self.root.join(path).to_string_lossy().into_owned(),
            false => self.below.display(path),
        }
    }

    fn on_disk(&self, path: &str) -> bool {
        self.open.contains_key(path) || self.below.on_disk(path)
    }

    fn embedded(&self) -> Option<Embedded> {
        self.below.embedded()
    }
}

/// A package as an editor has it: its manifest, and its files with the open ones in their place.
pub struct OpenedPackage {
    pub root: PathBuf,
    pub sources: SourceSet,
    pub packages: Packages,
    pub manifest: Option<Arc<Manifest>>,
    pub features: Features,
    /// The diagnostics of the files that declare the package.
    pub problems: Diagnostics,
}

/// Opens the package of a root folder. A manifest with errors is treated as missing, and its errors
/// are among the problems.
pub fn open_package(
    root: &Path,
    library: Embedded,
    texts: &OpenTexts,
    file_cache: &Arc<FileCache>,
    declared: &DeclaredPackages,
) -> Result<OpenedPackage, (SourceSet, Diagnostics)> {
    let mut sources = SourceSet::default();
    let packages = match root.exists() {
        true => project::packages(root, &mut sources, library),
        // An editor may have a file whose folder is not there yet.
        false => Ok(project::packages_without_folder(library)),
    };
    let packages = match packages {
        Ok(packages) => packages,
        Err(problems) => return Err((sources, problems)),
    };
    let mut own = Some(texts);
    let packages = packages.map(|package| {
        let none = OpenTexts::default();
        // The root comes first. Only its files may be open.
        cover_files(package, root, own.take().unwrap_or(&none), file_cache)
    });
    let declared = declared.or_read(root, sources);
    let mut problems = packages.warnings.clone();
    problems.extend(declared.problems.iter().cloned());
    Ok(OpenedPackage {
        root: root.to_owned(),
        sources: declared.sources.clone(),
        packages,
        manifest: declared.manifest.clone(),
        features: declared.features.clone(),
        problems,
    })
}

/// Makes a package read open texts in place of files, and cached texts of files that have not
/// changed.
fn cover_files(
    package: Package,
    root: &Path,
    texts: &OpenTexts,
    file_cache: &Arc<FileCache>,
) -> Package {
    let files = Box::new(EditorFiles {
        root: root.to_owned(),
        below: package.files,
        open: Arc::clone(texts),
        file_cache: Arc::clone(file_cache),
    });
    Package { name: package.name, files }
}

/// What a name stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WeslSymbol {
    /// The declarations of a name in a module.
    Items { node: u32, name: Name },
    /// A parameter or a local of a module, by the first byte of its declaration.
    Local { node: u32, declared: u32 },
    /// A feature or an axis, in a condition.
    Flag(Name),
    /// `constants::NAME`.
    Constant(u32),
}

/// Every module of the package, and those of others that they reach.
pub struct PackageModules {
    pub graph: Graph,
    pub sources: SourceSet,
}

/// Reads all modules of the opened package.
pub fn read_modules(opened: &mut OpenedPackage, kept: &mut KeptModules) -> Option<PackageModules> {
    let paths = opened.packages.root.files.list(&["wesl", "wgsl"]);
    let graph = load_all(&mut opened.sources, &opened.packages, &paths, kept)?;
    Some(PackageModules { graph, sources: opened.sources.clone() })
}

impl PackageModules {
    /// The module of a file of the package itself.
    pub fn node(&self, path: &str) -> Option<u32> {
        let stem = path.rsplit_once('.').map_or(path, |(stem, _)| stem);
        let is_it = |node: &ModuleNode| node.package == 0 && node.path.join("/") == stem;
        self.graph.nodes.iter().position(is_it).map(|index| index as u32)
    }

    /// The symbol at a byte of a module, with the range of its name there.
    pub fn symbol(&self, node: u32, byte: u32) -> Option<(WeslSymbol, Range<u32>)> {
        let module = &self.graph.nodes[node as usize].module;
        let has = |range: &Range<u32>| range.start <= byte && byte <= range.end;
        let flag =
            module.expressions.iter().flat_map(condition_flags).find(|(_, range)| has(range));
        if let Some((name, range)) = flag {
            return Some((WeslSymbol::Flag(name), range));
        }
        let local = module.local_uses.iter().find(|found| has(&(found.start..found.end)));
        if let Some(found) = local {
            let symbol = WeslSymbol::Local { node, declared: found.declared };
            return Some((symbol, found.start..found.end));
        }
        self.places_in(node).find(|(_, range)| has(range))
    }

    /// Items, constants and what imports bring, at each place of a module that names them.
    pub fn places_in(&self, node: u32) -> impl Iterator<Item = (WeslSymbol, Range<u32>)> {
        let here = &self.graph.nodes[node as usize];
        let uses = here.module.items.iter().flat_map(move |item| uses_of_item(here, node, item));
        let imports = here.module.imports.iter().zip(here.imports.iter());
        let imports = imports.flat_map(|(import, targets)| {
            let symbol = targets.iter().copied().find_map(symbol_of);
            let places = [import.path.range.clone(), import.alias_range.clone()];
            let distinct = usize::from(places[0].end < places[1].start) + 1;
            symbol.into_iter().flat_map(move |symbol| {
                places.clone().into_iter().take(distinct).map(move |place| (symbol, place))
            })
        });
        uses.chain(imports)
    }

    /// Where a symbol is declared.
    pub fn declarations(&self, symbol: WeslSymbol) -> Vec<Span> {
        match symbol {
            WeslSymbol::Items { node, name } => {
                let here = &self.graph.nodes[node as usize];
                let items = here.sets.get(&name).into_iter().flatten();
                let range = |index: &u32| here.module.items[*index as usize].name_range.clone();
                items.map(|index| here.module.span(range(index))).collect()
            }
            WeslSymbol::Local { node, declared } => {
                let module = &self.graph.nodes[node as usize].module;
                let place = module.local_uses.iter().find(|found| found.start == declared);
                place.map(|found| module.span(found.start..found.end)).into_iter().collect()
            }
            WeslSymbol::Flag(_) | WeslSymbol::Constant(_) => Vec::new(),
        }
    }

    /// Every place that names a symbol, its declarations included, by file and place.
    pub fn references(&self, symbol: WeslSymbol) -> Vec<Span> {
        let mut found = Vec::new();
        for (index, node) in self.graph.nodes.iter().enumerate() {
            let module = &node.module;
            match symbol {
                WeslSymbol::Local { node, declared } if node as usize == index => {
                    let uses = module.local_uses.iter().filter(|found| found.declared == declared);
                    found.extend(uses.map(|found| module.span(found.start..found.end)));
                }
                WeslSymbol::Local { .. } => {}
                WeslSymbol::Flag(name) => {
                    let flags = module.expressions.iter().flat_map(condition_flags);
                    let flags = flags.filter(|(flag, _)| *flag == name);
                    found.extend(flags.map(|(_, range)| module.span(range)));
                }
                _ => {
                    let places = self.places_in(index as u32).filter(|(known, _)| *known == symbol);
                    found.extend(places.map(|(_, range)| module.span(range)));
                }
            }
        }
        found.sort_unstable();
        found.dedup();
        found
    }

    /// A place that names the symbol under some conditions, and something else under others.
    pub fn divided_place(&self, symbol: WeslSymbol) -> Option<Span> {
        self.graph.nodes.iter().enumerate().find_map(|(index, here)| {
            let locals: BTreeMap<u32, u32> =
                here.module.local_uses.iter().map(|found| (found.start, found.declared)).collect();
            let events = here.module.items.iter().flat_map(|item| &item.events);
            events.clone().find_map(|event| {
                let Event::Use { reference, start, end, .. } = *event else { return None };
                let local = locals
                    .get(&start)
                    .map(|declared| WeslSymbol::Local { node: index as u32, declared: *declared });
                let candidates = here.bindings.get(reference as usize)?.iter();
                let global = candidates.filter_map(|candidate| symbol_of(candidate.target));
                let meanings: Vec<WeslSymbol> = local.into_iter().chain(global).collect();
                let is_divided =
                    meanings.contains(&symbol) && meanings.iter().any(|meaning| *meaning != symbol);
                is_divided.then(|| here.module.span(start..end))
            })
        })
    }

    /// The item of a symbol that is declared first.
    pub fn item(&self, symbol: WeslSymbol) -> Option<(&ModuleNode, &Item)> {
        let WeslSymbol::Items { node, name } = symbol else { return None };
        let here = &self.graph.nodes[node as usize];
        let index = here.sets.get(&name)?.first()?;
        Some((here, &here.module.items[*index as usize]))
    }
}

/// Names of a condition with their places.
fn condition_flags(expression: &Expression) -> Vec<(Name, Range<u32>)> {
    let named = |operand: &ComparisonOperand| match operand {
        ComparisonOperand::Name(name, range) => Some((*name, range.clone())),
        ComparisonOperand::Integer(..) => None,
    };
    match expression {
        Expression::Flag(name, range) => vec![(*name, range.clone())],
        Expression::Compare { left, right, .. } => {
            named(left).into_iter().chain(named(right)).collect()
        }
        _ => Vec::new(),
    }
}

fn symbol_of(target: PathTarget) -> Option<WeslSymbol> {
    match target {
        PathTarget::Items { node, name } => Some(WeslSymbol::Items { node, name }),
        PathTarget::Constant(index) => Some(WeslSymbol::Constant(index)),
        PathTarget::Module | PathTarget::Failed(_) => None,
    }
}

/// What an item declares and uses.
fn uses_of_item<'n>(
    here: &'n ModuleNode,
    node: u32,
    item: &'n Item,
) -> impl Iterator<Item = (WeslSymbol, Range<u32>)> + 'n {
    item.events.iter().filter_map(move |event| match *event {
        Event::Definition { start, end } => {
            Some((WeslSymbol::Items { node, name: item.name }, start..end))
        }
        Event::Use { reference, start, end, .. } => {
            let candidates = here.bindings.get(reference as usize)?;
            let found = candidates.iter().find_map(|candidate| symbol_of(candidate.target))?;
            Some((found, start..end))
        }
        Event::Cut { .. } | Event::Node { .. } => None,
    })
}
