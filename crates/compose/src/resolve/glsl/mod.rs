//! Every file that a GLSL file may include, under any settings.

mod include;

use std::collections::HashMap;

use crate::resolve::{Packages, ROOT};
use lamplight_diagnostic::source::{self, Embedded, LIMITS, SourceId, SourceSet, Span};
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes, nearest_name};
use lamplight_syntax::glsl::{Module, Symbols, parse};

/// The files reachable from a root file, tokenised, and where each `#include` leads.
#[derive(Debug)]
pub struct Graph {
    /// Path of the root file, relative to the root package.
    pub root: String,
    /// The root first, then in the order of first mention, breadth first.
    pub modules: Vec<Module>,
    /// The module with definitions that are read before the root.
    pub definitions: Option<usize>,
    /// The module that is read after the root.
    pub ending: Option<usize>,
    /// For each module, where each of its includes leads.
    pub targets: Vec<Vec<IncludeTarget>>,
    /// Spellings of all tokens.
    pub symbols: Symbols,
    /// For each module, its path as diagnostics show it.
    pub paths: Vec<String>,
    /// For each module, the number of its package; 0 is the root's.
    pub packages: Vec<usize>,
    /// What hints about unknown names are taken from.
    pub library: Option<Embedded>,
}

impl Graph {
    /// Whether any file of the graph mentions the macro of a setting.
    pub fn may_ask(&self, name: &str) -> bool {
        self.symbols.find(&name.to_uppercase()).is_some()
    }

    /// The includes that led to a file, as notes, from its own includer to one in the root file.
    pub fn trace(&self, source: SourceId) -> Vec<String> {
        let mut notes = Vec::new();
        let mut at = self.modules.iter().position(|module| module.source == source);
        while let Some((includer, span)) = at.and_then(|at| self.includer(at)) {
            let line = self.modules[includer].line(span.start);
            notes.push(format!("included from {}:{line}", self.paths[includer]));
            at = Some(includer);
        }
        notes
    }

    /// The diagnostic with the chain of includes that led to the file it stands in.
    pub fn traced(&self, diagnostic: Diagnostic) -> Diagnostic {
        let source = diagnostic.labels.first().map(|label| label.span.source);
        source
            .map(|source| self.trace(source))
            .into_iter()
            .flatten()
            .fold(diagnostic, Diagnostic::note)
    }

    /// Whether the file is in the root package.
    pub fn is_own(&self, source: SourceId) -> bool {
        self.modules
            .iter()
            .position(|module| module.source == source)
            .is_some_and(|module| self.packages[module] == ROOT)
    }

    /// For each file but the root, the `#include` that led to it first.
    pub fn includes(&self) -> impl Iterator<Item = (SourceId, Span)> {
        let found = |(at, module): (usize, &Module)| Some((module.source, self.includer(at)?.1));
        self.modules.iter().enumerate().filter_map(found)
    }

    /// The first file that includes a module, and the place of the `#include`. That file was read
    /// before the module, so following includers always ends.
    fn includer(&self, module: usize) -> Option<(usize, Span)> {
        self.targets[..module].iter().enumerate().find_map(|(includer, targets)| {
            let index = targets.iter().position(
                |target| matches!(target, IncludeTarget::Module(found) if *found == module),
            )?;
            Some((includer, self.modules[includer].includes[index].span))
        })
    }
}

/// Where an `#include` leads.
#[derive(Debug, Clone)]
pub enum IncludeTarget {
    /// Index of a module.
    Module(usize),
    /// Nowhere. This is an error once the directive is active.
    Missing(Box<Diagnostic>),
}

/// A package, by number, and a normalised path in it.
type PackagePath = (usize, String);

/// What has been read so far.
struct Loader<'a> {
    sources: &'a mut SourceSet,
    packages: &'a Packages,
    symbols: Symbols,
    modules: Vec<Module>,
    paths: Vec<String>,
    places: Vec<PackagePath>,
    known: HashMap<PackagePath, Result<Option<usize>, Box<Diagnostic>>>,
    listings: HashMap<usize, Vec<String>>,
}

/// Reads `root`, a path relative to the root package, and all that it may include.
///
/// A file that is missing or cannot be read is not an error here, since its `#include` may never be
/// active. A missing root is an error.
pub fn load(
    sources: &mut SourceSet,
    packages: &Packages,
    root: &str,
) -> Result<Graph, Diagnostics> {
    let mut loader = Loader::new(sources, packages);
    let path =
        include::normalize_path("", root).ok_or_else(|| vec![include::outside_package(root)])?;
    let place = (ROOT, path);
    if loader.module(&place).map_err(|error| vec![*error])?.is_none() {
        return Err(vec![Diagnostic::error(
            codes::MISSING_INCLUDE,
            format!("there is no file `{root}`"),
        )]);
    }
    loader.finish(root)
}

/// Reads the files of the root package at some paths, and all that they may include. This is for
/// editors, which ask who uses what. Those that cannot be read are left out.
pub fn load_all(
    sources: &mut SourceSet,
    packages: &Packages,
    paths: &[String],
) -> Result<Graph, Diagnostics> {
    let mut loader = Loader::new(sources, packages);
    for path in paths {
        // The errors of a file are reported when that file is checked on its own.
        let _ = loader.module(&(ROOT, path.clone()));
    }
    loader.finish("")
}

/// How a file of the root package may name the files that it can include, in quotes or in angles.
pub fn include_spellings(packages: &Packages, includer: &str, angled: bool) -> Vec<String> {
    let place = (ROOT, includer.to_owned());
    let mut found = Vec::new();
    for searched in include::searched_packages(packages, ROOT, angled) {
        let files = packages.package(searched.0).files.list(include::EXTENSIONS);
        let files = files.iter().filter(|file| searched.0 != ROOT || *file != includer);
        found.extend(files.map(|file| include::include_spelling(&place, searched, file, angled)));
    }
    found
}

impl<'a> Loader<'a> {
    fn new(sources: &'a mut SourceSet, packages: &'a Packages) -> Self {
        Self {
            sources,
            packages,
            symbols: Symbols::default(),
            modules: Vec::new(),
            paths: Vec::new(),
            places: Vec::new(),
            known: HashMap::new(),
            listings: HashMap::new(),
        }
    }

    /// Reads all that the files read so far include, directly or through others.
    fn finish(mut self, root: &str) -> Result<Graph, Diagnostics> {
        let mut targets = Vec::new();
        while targets.len() < self.modules.len() {
            let resolved = self.targets(targets.len())?;
            targets.push(resolved);
        }
        let packages = self.packages;
        let definitions = self.add_text("<definitions>", &packages.definitions);
        let ending = self.add_text("<ending>", &packages.ending);
        targets.resize_with(self.modules.len(), Vec::new);
        let library = self.packages.library();
        let Loader { modules, symbols, paths, places, .. } = self;
        let packages = places.into_iter().map(|(package, _)| package).collect();
        let root = root.to_owned();
        Ok(Graph { root, modules, definitions, ending, targets, symbols, paths, packages, library })
    }

    /// The module of a text from outside, if there is any.
    fn add_text(&mut self, name: &str, text: &str) -> Option<usize> {
        if text.is_empty() {
            return None;
        }
        let source = self.sources.add(name, text);
        Some(self.add(&(ROOT, name.to_owned()), source))
    }

    /// Resolves every include of a module that was read.
    fn targets(&mut self, module: usize) -> Result<Vec<IncludeTarget>, Diagnostics> {
        let includes: Vec<_> = self.modules[module]
            .includes
            .iter()
            .map(|include| (include.path.clone(), include.angled, include.span))
            .collect();
        let mut targets = Vec::with_capacity(includes.len());
        for (path, angled, span) in includes {
            targets.push(self.target(module, &path, angled, span));
            if self.modules.len() > LIMITS.files {
                let message = format!("more than {} files are included", LIMITS.files);
                return Err(vec![
                    Diagnostic::error(codes::TOO_MANY_FILES, message).at(span, "one too many"),
                ]);
            }
        }
        Ok(targets)
    }

    fn target(&mut self, module: usize, path: &str, angled: bool, span: Span) -> IncludeTarget {
        let places =
            match include::include_candidates(self.packages, &self.places[module], path, angled) {
                Ok(places) => places,
                Err(error) => return IncludeTarget::Missing(Box::new(error.at(span, "this path"))),
            };
        for place in places {
            match self.module(&place) {
                Ok(Some(found)) => return IncludeTarget::Module(found),
                Ok(None) => {}
                Err(error) => {
                    return IncludeTarget::Missing(Box::new(error.at(span, "included here")));
                }
            }
        }
        IncludeTarget::Missing(Box::new(self.missing(module, path, angled, span)))
    }

    fn missing(&mut self, module: usize, path: &str, angled: bool, span: Span) -> Diagnostic {
        let error = Diagnostic::error(codes::MISSING_INCLUDE, format!("cannot find `{path}`"))
            .at(span, "no such file");
        let includer = self.places[module].clone();
        let mut spellings = Vec::new();
        let packages = self.packages;
        if let Some((name, _)) = path.split_once('/').filter(|_| angled)
            && let Some(notes) = packages.undeclared_notes(includer.0, name)
        {
            return notes.into_iter().fold(error, Diagnostic::note);
        }
        for searched in include::searched_packages(packages, includer.0, angled) {
            let files = self
                .listings
                .entry(searched.0)
                .or_insert_with(|| packages.package(searched.0).files.list(include::EXTENSIONS));
            let spelled = files
                .iter()
                .map(|file| include::include_spelling(&includer, searched, file, angled));
            spellings.extend(spelled);
        }
        let noted = error.suggest(path, spellings.iter().map(String::as_str));
        match angled || !noted.notes.is_empty() {
            true => noted,
            false => self.angled(&includer, path, noted),
        }
    }

    /// Adds the file of another package that is meant by a path in quotes, which are for files of the
    /// own package.
    fn angled(&mut self, includer: &PackagePath, path: &str, error: Diagnostic) -> Diagnostic {
        let mut spellings = Vec::new();
        let packages = self.packages;
        for searched in include::searched_packages(packages, includer.0, true) {
            let files = self
                .listings
                .entry(searched.0)
                .or_insert_with(|| packages.package(searched.0).files.list(include::EXTENSIONS));
            let spelled =
                files.iter().map(|file| include::include_spelling(includer, searched, file, true));
            spellings.extend(spelled);
        }
        let known = spellings.iter().map(String::as_str);
        let same = known.clone().find(|known| *known == path);
        match same.or_else(|| nearest_name(path, known)) {
            Some(near) => error.note(format!(
                "help: files of other packages stand between `<` and `>`: write `#include <{near}>`"
            )),
            None => error,
        }
    }

    /// The module at a place, which is read when first asked for.
    fn module(&mut self, place: &PackagePath) -> Result<Option<usize>, Box<Diagnostic>> {
        if let Some(known) = self.known.get(place) {
            return known.clone();
        }
        let package = self.packages.package(place.0);
        let read =
            source::read(self.sources, package, &place.1).map_err(|error| Box::new(error.into()));
        let found = read.map(|source| source.map(|source| self.add(place, source)));
        self.known.insert(place.clone(), found.clone());
        found
    }

    fn add(&mut self, place: &PackagePath, source: SourceId) -> usize {
        let module = parse(self.sources, source, &mut self.symbols);
        self.modules.push(module);
        self.paths.push(self.sources.get(source).path.clone());
        self.places.push(place.clone());
        self.modules.len() - 1
    }
}
