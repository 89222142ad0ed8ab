//! Finds what a path names: follows imports and packages to a module, and finds the item in it.

use std::sync::Arc;

use super::graph::{Candidate, ConstantUse, NodeCondition, PathTarget};
use super::load::Loader;
use lamplight_diagnostic::source::{LIMITS, Span};
use lamplight_diagnostic::{Diagnostic, codes};
use lamplight_syntax::wesl::{Name, Origin, Path, PlacedModule};

/// A path from a package's root.
#[derive(Debug, Clone)]
pub(super) struct Absolute {
    /// `None` for the virtual package `constants`.
    pub package: Option<usize>,
    pub segments: Vec<Name>,
    pub conditions: Vec<NodeCondition>,
}

/// The most meanings that one path may have under different conditions.
const MEANINGS: usize = 64;

/// The most failures of a graph for which names are suggested.
const SUGGESTED: usize = 100;

/// The places of a path that an error may be about.
#[derive(Debug, Clone, Copy)]
struct PathPlaces {
    whole: Span,
    first: Span,
    /// All names but the last; the whole path if these are not written in one piece.
    parents: Span,
    last: Span,
}

/// Where a path is used.
#[derive(Debug, Clone, Copy)]
struct PathUse {
    node: u32,
    places: PathPlaces,
    /// Whether it is the path of an import, which may name a module.
    is_import: bool,
    /// How many `public import` statements led to it.
    depth: usize,
}

impl PathPlaces {
    fn new(module: &PlacedModule, path: &Path) -> Self {
        let whole = module.span(path.range.clone());
        let parents = Some(path.parts.parents.clone()).filter(|range| range.start < range.end);
        Self {
            whole,
            first: module.span(path.parts.first.clone()),
            parents: parents.map_or(whole, |range| module.span(range)),
            last: module.span(path.parts.last.clone()),
        }
    }
}

impl Loader<'_> {
    /// What a path in a module may mean. `import` is the index of the import that has the path, if
    /// one has it: the name that this import brings does not count for the path's first segment,
    /// and the path may name a module.
    pub(super) fn candidates(
        &mut self,
        node: u32,
        path: &Path,
        import: Option<usize>,
    ) -> Vec<Candidate> {
        self.candidates_within(node, path, import, 0)
    }

    /// As [`Self::candidates`], below so many `public import` statements that led to the module.
    pub(super) fn candidates_within(
        &mut self,
        node: u32,
        path: &Path,
        import: Option<usize>,
        depth: usize,
    ) -> Vec<Candidate> {
        if !self.step(1) {
            return Vec::new();
        }
        let places = PathPlaces::new(&self.nodes[node as usize].module, path);
        let mut visiting: Vec<usize> = import.into_iter().collect();
        let found = self.absolute(node, path, &mut visiting).and_then(|absolutes| {
            let mut found = Vec::new();
            for absolute in absolutes {
                let place = PathUse { node, places, is_import: import.is_some(), depth };
                for mut candidate in self.targets(&absolute, place)? {
                    candidate.conditions.extend(&absolute.conditions);
                    found.push(candidate);
                }
            }
            Ok(found)
        });
        found.unwrap_or_else(|error| vec![Candidate::certain(self.fail(error))])
    }

    /// The path from a package's root, for each import that its first segment may mean.
    pub(super) fn absolute(
        &self,
        node: u32,
        path: &Path,
        visiting: &mut Vec<usize>,
    ) -> Result<Vec<Absolute>, Diagnostic> {
        let here = &self.nodes[node as usize];
        let places = PathPlaces::new(&here.module, path);
        match path.origin {
            Origin::Package => Ok(vec![Absolute {
                package: Some(here.package),
                segments: path.segments.clone(),
                conditions: Vec::new(),
            }]),
            Origin::Super(ups) => {
                let place = places.whole;
                self.above(node, ups as usize, &path.segments, place).map(|absolute| vec![absolute])
            }
            // The path of an import starts with a package, even where another import brings the
            // same name.
            Origin::Scope if !visiting.is_empty() && self.is_package(node, path.segments[0]) => {
                self.in_package(node, &path.segments, places, false).map(|absolute| vec![absolute])
            }
            Origin::Scope => {
                let named = here.aliases.get(&path.segments[0]).into_iter().flatten();
                let (seen, through): (Vec<usize>, Vec<usize>) =
                    named.partition(|index| visiting.contains(index));
                if through.is_empty() {
                    let cyclic = visiting.len() > 1 && !seen.is_empty();
                    return self
                        .in_package(node, &path.segments, places, cyclic)
                        .map(|absolute| vec![absolute]);
                }
                self.through_imports(node, path, &through, visiting)
            }
        }
    }

    fn through_imports(
        &self,
        node: u32,
        path: &Path,
        imports: &[usize],
        visiting: &mut Vec<usize>,
    ) -> Result<Vec<Absolute>, Diagnostic> {
        let module = &self.nodes[node as usize].module;
        let many = || {
            let message = format!("a path with more than {MEANINGS} meanings");
            Diagnostic::error(codes::CYCLIC_IMPORT, message)
                .at(module.span(path.range.clone()), "here")
        };
        // Each import has a meaning or an error, so a bound on imports bounds the meanings.
        if imports.len() > MEANINGS || !self.step(imports.len()) {
            return Err(many());
        }
        let mut found = Vec::new();
        for index in imports {
            let import = &module.imports[*index];
            visiting.push(*index);
            if visiting.len() > LIMITS.include_depth {
                return Err(cyclic_import(module.span(path.range.clone())));
            }
            for mut absolute in self.absolute(node, &import.path, visiting)? {
                let own = import.condition;
                absolute.conditions.extend(own.map(|condition| NodeCondition { node, condition }));
                absolute.segments.extend(&path.segments[1..]);
                found.push(absolute);
            }
            visiting.pop();
            if found.len() > MEANINGS {
                return Err(many());
            }
        }
        Ok(found)
    }

    fn above(
        &self,
        node: u32,
        ups: usize,
        segments: &[Name],
        span: Span,
    ) -> Result<Absolute, Diagnostic> {
        let here = &self.nodes[node as usize];
        let Some(depth) = here.path.len().checked_sub(ups) else {
            let message = format!(
                "the path leaves the root of its package: `{}` is {} deep",
                here.label,
                here.path.len()
            );
            return Err(Diagnostic::error(codes::OUTSIDE_ROOT, message)
                .at(span, format!("{ups} times `super`")));
        };
        let above = here.path[..depth].iter().filter_map(|part| self.names.find(part));
        let segments = above.chain(segments.iter().copied()).collect();
        Ok(Absolute { package: Some(here.package), segments, conditions: Vec::new() })
    }

    /// Whether a path may start with the name as that of a package.
    fn is_package(&self, node: u32, name: Name) -> bool {
        let text = self.names.text(name);
        let importer = self.nodes[node as usize].package;
        name == Name::CONSTANTS || self.packages.find(importer, text).is_some()
    }

    fn in_package(
        &self,
        node: u32,
        segments: &[Name],
        places: PathPlaces,
        in_circle: bool,
    ) -> Result<Absolute, Diagnostic> {
        let first = self.names.text(segments[0]);
        let package = match self.packages.find(self.nodes[node as usize].package, first) {
            Some(number) => Some(number),
            None if segments[0] == Name::CONSTANTS => None,
            None if in_circle => return Err(cyclic_import(places.whole)),
            None => return Err(self.unknown_package(node, first, places.first)),
        };
        Ok(Absolute { package, segments: segments[1..].to_vec(), conditions: Vec::new() })
    }

    fn unknown_package(&self, node: u32, first: &str, span: Span) -> Diagnostic {
        let error =
            Diagnostic::error(codes::UNKNOWN_PACKAGE, format!("there is no package `{first}`"))
                .at(span, "not a package");
        let importer = self.nodes[node as usize].package;
        let files = self.listing(importer);
        let own = files.iter().any(|file| file.split(['/', '.']).next() == Some(first));
        if own {
            return error
                .note(format!("help: for the module of this package write `package::{first}`"));
        }
        if let Some(notes) = self.packages.undeclared_notes(importer, first) {
            return notes.into_iter().fold(error, Diagnostic::note);
        }
        let known = self.packages.scope(importer).names.keys().map(String::as_str);
        error.suggest(first, known.chain(["package", "super"]))
    }

    fn targets(
        &mut self,
        absolute: &Absolute,
        place: PathUse,
    ) -> Result<Vec<Candidate>, Diagnostic> {
        let (places, span) = (place.places, place.places.whole);
        let Some(package) = absolute.package else {
            return Ok(vec![Candidate::certain(self.constant(&absolute.segments, span))]);
        };
        let Some((last, parents)) = absolute.segments.split_last() else {
            return Ok(vec![Candidate::certain(PathTarget::Module)]);
        };
        let parent = self.ask_module(package, parents, span)?;
        if let Some(there) = parent {
            let found = self.items(there, *last, place)?;
            if !found.is_empty() {
                return Ok(found);
            }
            self.notes.lacks.push((there, *last));
        }
        if self.is_module(package, &absolute.segments, span, place.is_import)? {
            return Ok(vec![Candidate::certain(PathTarget::Module)]);
        }
        Err(match parent {
            // The missing item may be in the part of the module that could not be parsed.
            Some(node) if !self.nodes[node as usize].module.errors.is_empty() => {
                self.nodes[node as usize].module.errors[0].clone()
            }
            Some(node) => self.missing_item(node, *last, places.last),
            // The last name may be an item or a module. Below a folder it is a module.
            None if parents.is_empty() || self.is_module(package, parents, span, false)? => {
                self.missing_module(package, &absolute.segments, span)
            }
            None => self.missing_module(package, parents, places.parents),
        })
    }

    /// What a name means in a module that a path leads to: what it declares, and what it passes on.
    fn items(
        &mut self,
        there: u32,
        name: Name,
        place: PathUse,
    ) -> Result<Vec<Candidate>, Diagnostic> {
        let [here, other] = [place.node, there].map(|node| &self.nodes[node as usize]);
        let mut found = Vec::new();
        if let Some(first) = other.sets.get(&name).and_then(|set| set.first()) {
            if !other.shows_name(name, here) {
                let item = &other.module.items[*first as usize];
                return Err(other.not_visible(&self.names, item, place.places.last));
            }
            found.push(Candidate::certain(PathTarget::Items { node: there, name }));
        }
        found.extend(self.passed_on(there, name, place.depth));
        Ok(found)
    }

    fn constant(&mut self, segments: &[Name], span: Span) -> PathTarget {
        match segments {
            [] => PathTarget::Module,
            [name] => {
                let next = self.constants.len() as u32;
                let index = *self.constant_places.entry(*name).or_insert(next);
                if index == next {
                    self.constants.push(ConstantUse { name: *name, span });
                }
                PathTarget::Constant(index)
            }
            _ => self.fail(
                Diagnostic::error(codes::MISSING_MODULE, "the module `constants` has no modules")
                    .at(span, "too long a path"),
            ),
        }
    }

    /// Whether there is a module or a folder at a path. For an import the module is read. If that
    /// finds none, or for other paths, the listing of the package's files decides.
    fn is_module(
        &mut self,
        package: usize,
        segments: &[Name],
        span: Span,
        import: bool,
    ) -> Result<bool, Diagnostic> {
        let path = segments.iter().map(|name| self.names.text(*name)).collect::<Vec<_>>().join("/");
        if import && self.ask_module(package, segments, span)?.is_some() {
            return Ok(true);
        }
        self.notes.is_open = true;
        // The listing is sorted, so if any file begins with `start`, the first one not before it
        // does.
        let listing = self.listing(package);
        let begins = |start: String| {
            let at = listing.partition_point(|file| *file < start);
            listing.get(at).is_some_and(|file| file.starts_with(&start))
        };
        Ok(begins(format!("{path}/")) || begins(format!("{path}.")))
    }

    fn missing_item(&mut self, node: u32, name: Name, span: Span) -> Diagnostic {
        let here = &self.nodes[node as usize];
        let text = self.names.text(name);
        let error = Diagnostic::error(
            codes::MISSING_ITEM,
            format!("`{}` has no item `{text}`", here.label),
        )
        .at(span, "not found");
        let imports = here.module.imports.iter().any(|import| import.alias == name);
        let error = if imports {
            error.note("it imports that name, but only a `public import` passes it on")
        } else {
            error
        };
        let suggested = if self.failures.len() < SUGGESTED { here.module.items.len() } else { 0 };
        error.suggest(
            text,
            here.module.items.iter().take(suggested).map(|item| self.names.text(item.name)),
        )
    }

    pub(super) fn missing_module(
        &mut self,
        package: usize,
        path: &[Name],
        span: Span,
    ) -> Diagnostic {
        let path: Vec<String> = path.iter().map(|name| self.names.text(*name).to_owned()).collect();
        let label = self.label(package, &path);
        let shown = self.package(package).files.display(&path.join("/"));
        let listing =
            if self.failures.len() < SUGGESTED { self.listing(package) } else { Arc::default() };
        let mut known: Vec<String> = Vec::new();
        for file in listing.iter() {
            let parts: Vec<String> = file
                .rsplit_once('.')
                .map_or(file.as_str(), |(stem, _)| stem)
                .split('/')
                .map(str::to_owned)
                .collect();
            known.extend((1..=parts.len()).map(|depth| self.label(package, &parts[..depth])));
        }
        Diagnostic::error(codes::MISSING_MODULE, format!("there is no module `{label}`"))
            .at(span, "not found")
            .note(format!("looked for `{shown}.wesl` and `{shown}.wgsl`"))
            .suggest(&label, known.iter().map(String::as_str))
    }
}

fn cyclic_import(span: Span) -> Diagnostic {
    Diagnostic::error(codes::CYCLIC_IMPORT, "imports refer to each other in a cycle")
        .at(span, "leads back to itself")
}
