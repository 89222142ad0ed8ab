//! Reads modules until no path leads to a new one.

use std::cell::{Cell, RefCell};
use std::collections::{BTreeMap, HashMap};
use std::sync::Arc;

use rustc_hash::{FxHashMap, FxHashSet};

use super::cache::{KeptModules, ParsedModule};
use super::graph::{
    Bases, Candidate, ConstantUse, Graph, Importer, ModuleNode, NodeCondition, PathTarget,
    certain_errors,
};
use super::lint;
use super::reduce::Reductions;
use super::replay::LoadNotes;
use super::wildcard::WildcardModule;
use crate::resolve::Packages;
use lamplight_diagnostic::source::{self, LIMITS, Package, SourceId, SourceSet, Span};
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};
use lamplight_files::limits::{RESOLVE_FACTOR, RESOLVE_STEPS, Steps};
use lamplight_syntax::wesl::{self, Name, Names, PlacedModule, UsedName};

/// The graph that is being built.
pub struct Loader<'a> {
    pub(super) sources: &'a mut SourceSet,
    pub(super) packages: &'a Packages,
    pub(super) names: Names,
    pub(super) nodes: Vec<ModuleNode>,
    pub(super) constants: Vec<ConstantUse>,
    /// By name: the index in `constants`.
    pub(super) constant_places: FxHashMap<Name, u32>,
    pub(super) failures: Vec<Diagnostic>,
    /// Parsed texts of earlier readings, for editors.
    pub(super) kept: Option<&'a mut KeptModules>,
    /// Reduces the modules that are far from the root, for checks of whole packages.
    reductions: Option<&'a mut Reductions>,
    /// By package and path: the node of a file, `None` if there is no such file, or why it cannot
    /// be read.
    known: HashMap<(usize, String), Result<Option<u32>, Diagnostic>>,
    /// The files of a package, once a module of it is missing.
    listings: RefCell<FxHashMap<usize, Arc<Vec<String>>>>,
    /// The steps that looking names up may still take.
    steps: Cell<Steps>,
    /// The steps that looking names up has taken.
    pub(super) spent: Cell<u64>,
    /// What the resolving of the present module asked.
    pub(super) notes: LoadNotes,
    /// The root module, by which earlier results are kept.
    pub(super) root: String,
    /// By file: the byte whose line and column were asked for last, then that line and column.
    positions: FxHashMap<SourceId, (usize, usize, usize)>,
    /// For `is_used`: the module that was asked about last, and the names that it uses.
    used: Option<(u32, FxHashSet<Name>)>,
}

impl<'a> Loader<'a> {
    pub fn new(sources: &'a mut SourceSet, packages: &'a Packages) -> Self {
        Self {
            sources,
            packages,
            names: Names::default(),
            nodes: Vec::new(),
            constants: Vec::new(),
            constant_places: FxHashMap::default(),
            failures: Vec::new(),
            kept: None,
            reductions: None,
            known: HashMap::new(),
            listings: RefCell::default(),
            steps: Cell::new(Steps::new(RESOLVE_STEPS)),
            spent: Cell::new(0),
            notes: LoadNotes::default(),
            root: String::new(),
            positions: FxHashMap::default(),
            used: None,
        }
    }

    /// With the parsed texts of earlier readings, and the results of those with the same root. The
    /// loader gives back what it took.
    pub fn with_kept(mut self, kept: &'a mut KeptModules, root: &str) -> Self {
        self.names = kept.begin(self.packages);
        self.kept = Some(kept);
        root.clone_into(&mut self.root);
        self
    }

    /// Reads as [`Reductions`] say.
    pub fn with_reductions(self, reductions: &'a mut Reductions) -> Self {
        Self { reductions: Some(reductions), ..self }
    }

    /// Reads the root module; false if there is no such file.
    pub fn root(&mut self, file: &str) -> Result<bool, Diagnostic> {
        let Some(source) = source::read(self.sources, &self.packages.root, file)? else {
            return Ok(false);
        };
        let stem =
            file.strip_suffix(".wesl").or_else(|| file.strip_suffix(".wgsl")).unwrap_or(file);
        let path: Vec<String> = stem
            .split('/')
            .filter(|part| !part.is_empty() && *part != ".")
            .map(str::to_owned)
            .collect();
        self.known.insert((0, path.join("/")), Ok(Some(0)));
        self.add(source, 0, path, None);
        Ok(true)
    }

    /// Resolves every module that was read and all that they lead to.
    pub fn finish(mut self) -> Result<Graph, Diagnostics> {
        let mut at = 0;
        while at < self.nodes.len() {
            self.resolve(at as u32);
            at += 1;
        }
        let steps = self.steps.get();
        if steps.is_exhausted() {
            return Err(vec![too_entangled(&self.nodes[0].module, steps.most())]);
        }
        let graph = self.graph();
        let errors = certain_errors(&graph);
        if errors.is_empty() { Ok(graph) } else { Err(errors) }
    }

    /// The graph of the modules at some paths of the root package, and of all that they lead to.
    /// Errors stay in the graph. Modules that cannot be read are left out. `None` if none can be
    /// read, or if looking names up takes too many steps.
    pub fn every(mut self, paths: &[String]) -> Option<Graph> {
        for path in paths {
            let stem = path.rsplit_once('.').map_or(path.as_str(), |(stem, _)| stem);
            if self.known.contains_key(&(0, stem.to_owned())) || self.nodes.len() >= LIMITS.files {
                continue;
            }
            let Ok(Some(source)) = source::read(self.sources, &self.packages.root, path) else {
                continue;
            };
            let node = self.nodes.len() as u32;
            self.known.insert((0, stem.to_owned()), Ok(Some(node)));
            self.add(source, 0, stem.split('/').map(str::to_owned).collect(), None);
        }
        let mut at = 0;
        while at < self.nodes.len() {
            self.resolve(at as u32);
            at += 1;
        }
        if self.steps.get().is_exhausted() {
            return None;
        }
        (!self.nodes.is_empty()).then(|| self.graph())
    }

    fn graph(mut self) -> Graph {
        let mut totals = Bases::default();
        let mut nodes = std::mem::take(&mut self.nodes);
        let mut by_source = BTreeMap::new();
        for (index, node) in nodes.iter_mut().enumerate() {
            node.bases = totals;
            totals.items += node.module.items.len() as u32;
            totals.conditions += node.module.conditions.len() as u32;
            totals.bindings += node.bindings.len() as u32;
            by_source.insert(node.module.source, index as u32);
        }
        let mut order: Vec<u32> = (1..nodes.len() as u32).collect();
        order.sort_by(|left, right| nodes[*left as usize].label.cmp(&nodes[*right as usize].label));
        order.push(0);
        let names = Arc::new(std::mem::take(&mut self.names));
        if let Some(kept) = &mut self.kept {
            kept.end(Arc::clone(&names));
        }
        Graph {
            names,
            nodes,
            order,
            constants: self.constants,
            failures: self.failures,
            totals,
            by_source,
            library: self.packages.library(),
        }
    }

    pub(super) fn package(&self, number: usize) -> &'a Package {
        self.packages.package(number)
    }

    /// The module of a package at a path, which is read when first asked for.
    pub(super) fn module(
        &mut self,
        package: usize,
        path: &[Name],
        asker: Span,
    ) -> Result<Option<u32>, Diagnostic> {
        let path: Vec<String> = path.iter().map(|name| self.names.text(*name).to_owned()).collect();
        let key = (package, path.join("/"));
        if let Some(known) = self.known.get(&key) {
            return known.clone();
        }
        let outcome = self.read(package, &path, asker);
        self.known.insert(key, outcome.clone());
        outcome
    }

    fn read(
        &mut self,
        package: usize,
        path: &[String],
        asker: Span,
    ) -> Result<Option<u32>, Diagnostic> {
        for stem in self.stems(package, path) {
            // A package's own module may also be reached by the name of its file.
            if let Some(known @ (Ok(Some(_)) | Err(_))) = self.known.get(&(package, stem.clone())) {
                return known.clone();
            }
            for extension in ["wesl", "wgsl"] {
                let found = source::read(
                    self.sources,
                    self.package(package),
                    &format!("{stem}.{extension}"),
                )
                .map_err(|error| Diagnostic::from(error).at(asker, "imported here"))?;
                if let Some(source) = found {
                    if self.nodes.len() >= LIMITS.files {
                        let message = format!("more than {} modules", LIMITS.files);
                        return Err(Diagnostic::error(codes::TOO_MANY_FILES, message)
                            .at(asker, "the first one too many"));
                    }
                    let node = self.add(source, package, path.to_vec(), Some(asker));
                    self.known.insert((package, stem), Ok(Some(node)));
                    return Ok(Some(node));
                }
            }
        }
        Ok(None)
    }

    /// Where a module's file may be: a package's own module is `package`, `lib` or its name.
    fn stems(&self, package: usize, path: &[String]) -> Vec<String> {
        match path {
            [] => vec!["package".to_owned(), "lib".to_owned(), self.package(package).name.clone()],
            path => vec![path.join("/")],
        }
    }

    fn add(
        &mut self,
        source: SourceId,
        package: usize,
        path: Vec<String>,
        asker: Option<Span>,
    ) -> u32 {
        let source = match &mut self.reductions {
            Some(reductions) => reductions.source(self.sources, source),
            None => source,
        };
        let text = self.sources.get(source).text.clone();
        let mut steps = self.steps.get();
        steps.grant(RESOLVE_FACTOR.saturating_mul(text.len() as u64));
        self.steps.set(steps);
        let ParsedModule { module, sets, aliases } = match &mut self.kept {
            Some(kept) => kept.parse(source, text, &mut self.names),
            None => ParsedModule::new(Arc::new(wesl::parse(source, text, &mut self.names))),
        };
        let module = PlacedModule::new(module, source);
        path.iter().for_each(|part| {
            self.names.intern(part);
        });
        let label = self.label(package, &path);
        let importer = asker.map(|span| Importer { span, note: self.note(span) });
        self.nodes.push(ModuleNode {
            module,
            package,
            path,
            label,
            sets,
            aliases,
            imports: Arc::default(),
            bindings: Arc::default(),
            broken_imports: Vec::new(),
            passed: Vec::new(),
            duplicates: Vec::new(),
            lints: Vec::new(),
            importer,
            bases: Bases::default(),
        });
        self.nodes.len() as u32 - 1
    }

    pub(super) fn label(&self, package: usize, path: &[String]) -> String {
        let first = if package == 0 { "package" } else { &self.package(package).name };
        std::iter::once(first).chain(path.iter().map(String::as_str)).collect::<Vec<_>>().join("::")
    }

    /// Where an import stands, as `imported by FILE:LINE:COLUMN`. Lines are counted on from the
    /// import before, so each file is read once.
    fn note(&mut self, span: Span) -> String {
        let (at, text) = (span.start as usize, &self.sources.get(span.source).text);
        let known = self.positions.get(&span.source).copied().filter(|(before, ..)| *before <= at);
        let (before, mut line, mut column) = known.unwrap_or((0, 1, 1));
        let passed = text.get(before..at).unwrap_or_default();
        if let Some((lines, last)) = passed.rsplit_once('\n') {
            line += 1 + lines.matches('\n').count();
            column = 1 + last.chars().count();
        } else {
            column += passed.chars().count();
        }
        self.positions.insert(span.source, (at, line, column));
        format!("imported by {}:{line}:{column}", self.sources.get(span.source).path)
    }

    /// Files of a package, sorted.
    pub(super) fn listing(&self, package: usize) -> Arc<Vec<String>> {
        let files = &self.package(package).files;
        let mut listings = self.listings.borrow_mut();
        let listing = listings.entry(package);
        Arc::clone(listing.or_insert_with(|| Arc::new(files.list(&["wesl", "wgsl"]))))
    }

    /// Whether anything in a module uses a name.
    pub(super) fn is_used(&mut self, node: u32, name: Name) -> bool {
        let known = self.used.take().filter(|(known, _)| *known == node);
        let (_, names) = self
            .used
            .insert(known.unwrap_or_else(|| (node, lint::used_names(&self.nodes[node as usize]))));
        names.contains(&name)
    }

    /// Spends steps of looking names up; false if fewer than these are left.
    pub(super) fn step(&self, steps: usize) -> bool {
        let mut left = self.steps.get();
        let outcome = left.spend(steps as u64);
        self.steps.set(left);
        self.spent.set(self.spent.get() + steps as u64);
        outcome.is_ok()
    }

    pub(super) fn fail(&mut self, error: Diagnostic) -> PathTarget {
        self.failures.push(error);
        PathTarget::Failed(self.failures.len() as u32 - 1)
    }

    /// Resolves a module's imports, then its uses.
    pub(super) fn resolve_anew(&mut self, node: u32) {
        let imported = self.imported(node);
        let wildcards = self.wildcards(node);
        let references = self.nodes[node as usize].module.references.clone();
        let binding = |reference| self.binding(node, reference, &imported, &wildcards);
        let bindings = references.iter().map(binding).collect();
        self.nodes[node as usize].bindings = Arc::new(bindings);
        lint::report_clashes(self, node, &imported);
        lint::report_duplicates(self, node);
        let mut lints = lint::import_lints(self, &self.nodes[node as usize]);
        lints.extend(lint::shadowed_wildcards(self, node, &wildcards));
        lints.extend(lint::hidden_builtins(self, node));
        self.nodes[node as usize].lints = lints;
    }

    /// What the imports of a module bring, by name.
    fn imported(&mut self, node: u32) -> FxHashMap<Name, Vec<Candidate>> {
        let module = self.nodes[node as usize].module.shared();
        let mut imported: FxHashMap<Name, Vec<Candidate>> = FxHashMap::default();
        let mut found = Vec::new();
        for (index, import) in module.imports.iter().enumerate() {
            let own = import.condition.map(|condition| NodeCondition { node, condition });
            let mut targets = Vec::new();
            for mut candidate in self.candidates(node, &import.path, Some(index)) {
                candidate.conditions.extend(own);
                if import.is_public {
                    candidate = self.passed_candidate(node, import, candidate);
                    self.nodes[node as usize].passed.push((import.alias, candidate.clone()));
                }
                targets.push(candidate.target);
                // An import that nothing uses is no error if it leads nowhere. That there are too many
                // modules is one, whoever asks for the one too many.
                if let PathTarget::Failed(failure) = candidate.target
                    && (import.is_public
                        || self.failures[failure as usize].code == codes::TOO_MANY_FILES
                        || self.is_used(node, import.alias))
                {
                    let broken = &mut self.nodes[node as usize].broken_imports;
                    broken.push((candidate.conditions.clone(), failure));
                }
                imported.entry(import.alias).or_default().push(candidate);
            }
            found.push(targets);
        }
        self.nodes[node as usize].imports = Arc::new(found);
        imported
    }

    fn binding(
        &mut self,
        node: u32,
        reference: &UsedName,
        imported: &FxHashMap<Name, Vec<Candidate>>,
        wildcards: &[WildcardModule],
    ) -> Vec<Candidate> {
        match reference {
            UsedName::Path(path) => self.candidates(node, path, None),
            UsedName::Name(name) => {
                if !self.step(1 + imported.get(name).map_or(0, Vec::len)) {
                    return Vec::new();
                }
                let own = self.nodes[node as usize].sets.contains_key(name);
                let own = own.then(|| Candidate::certain(PathTarget::Items { node, name: *name }));
                let named = imported.get(name).into_iter().flatten().cloned();
                let found: Vec<Candidate> = own.into_iter().chain(named).collect();
                let brought = wildcards.iter().flat_map(|module| self.brought(node, module, *name));
                found.into_iter().chain(brought).collect()
            }
        }
    }
}

/// The error for a graph in which looking names up takes more than `most` steps.
pub fn too_entangled(module: &PlacedModule, most: u64) -> Diagnostic {
    let message = format!("resolving the names here takes more than {most} steps");
    Diagnostic::error(codes::LIMIT_EXCEEDED, message)
        .at(module.span(0..0), "in this file and what it imports")
}
