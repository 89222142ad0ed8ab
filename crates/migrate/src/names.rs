//! Maps import paths to files. In `naga_oil` a file declares its path; in WESL the path follows
//! from where the file is.

use std::collections::{BTreeMap, BTreeSet};

use super::tree::{ImportLeaf, Node, Scanned};
use lamplight_diagnostic::source::{SourceId, Span};
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};
use lamplight_syntax::wesl;
use lamplight_syntax::words::is_word;

/// Every module of the folder.
pub struct FolderModules {
    /// The path in WESL of each module, by its path in `naga_oil`.
    paths: BTreeMap<Vec<String>, Result<String, String>>,
    /// The path in WESL of each file.
    files: BTreeMap<String, Result<String, String>>,
    /// Modules that no file defines, each with the first place that imports from it.
    foreign: BTreeMap<String, Span>,
    /// Every word of each module.
    words: BTreeMap<Vec<String>, BTreeSet<String>>,
}

/// Where a path of `naga_oil` leads.
pub enum PathDestination {
    /// A module, or what is in one.
    Known(String),
    /// No file defines it: it may be a package.
    Foreign,
    /// No module has this path, but the paths of some modules start with it.
    Prefix,
}

impl FolderModules {
    pub fn new<'a>(
        files: impl Iterator<Item = (&'a str, &'a str, SourceId, &'a Scanned)>,
        warnings: &mut Diagnostics,
    ) -> Self {
        let mut modules = Self {
            paths: BTreeMap::new(),
            files: BTreeMap::new(),
            foreign: BTreeMap::new(),
            words: BTreeMap::new(),
        };
        let (mut imports, mut places) = (Vec::new(), BTreeMap::new());
        for (path, text, id, found) in files {
            let place = place_of(path);
            modules.files.insert(path.to_owned(), place.clone());
            imports.extend(found.imports.iter().map(|import| (id, import)));
            let Some((name, range)) = &found.name else { continue };
            let span = Span::new(id, range.clone());
            let segments: Vec<String> = name.split("::").map(str::to_owned).collect();
            let words = compiled_words(text, &found.nodes);
            // Of two files that define a module, the one with more words counts. The other one is a
            // substitute for builds without it.
            let other = places.get(&segments).copied();
            let counts = modules.words.get(&segments).is_none_or(|known| known.len() < words.len());
            let (kept, left) =
                if counts { (span, other) } else { (other.unwrap_or(span), Some(span)) };
            if let Some(left) = left {
                let message = format!("two files define `{name}`");
                let warning = Diagnostic::warning(codes::MIGRATED_OTHERWISE, message);
                warnings.push(warning.at(left, "imports do not lead here").at(kept, "but here"));
            }
            if counts {
                places.insert(segments.clone(), span);
                modules.words.insert(segments.clone(), words);
                modules.paths.insert(segments, place);
            }
        }
        for (id, import) in imports {
            modules.look_up(Span::new(id, import.at.clone()), &import.path, warnings);
        }
        modules
    }

    /// Notes what an import names that is not there.
    fn look_up(&mut self, span: Span, path: &[String], warnings: &mut Diagnostics) {
        if let Ok(PathDestination::Foreign) = self.place(path) {
            self.foreign.entry(path[0].clone()).or_insert(span);
        }
        if let Some((last, module)) = path.split_last()
            && self.lacks(module, last)
        {
            let message = format!("`{}` has no `{last}`", module.join("::"));
            let warning = Diagnostic::warning(codes::MIGRATED_OTHERWISE, message);
            warnings.push(warning.at(span, "not imported any more"));
        }
    }

    /// Whether a module is there, and nothing in it has that name.
    pub fn lacks(&self, module: &[String], name: &str) -> bool {
        let whole = || module.iter().map(String::as_str).chain([name]);
        self.words.get(module).is_some_and(|words| !words.contains(name))
            && !self.paths.keys().any(|known| {
                known.len() > module.len()
                    && known.iter().map(String::as_str).zip(whole()).all(|(a, b)| a == b)
            })
    }

    /// Where a path leads; the error says why its file has no path in WESL.
    pub fn place(&self, path: &[String]) -> Result<PathDestination, String> {
        if let Some(file) = path.first().and_then(|first| first.strip_prefix('"')) {
            let file = file.trim_end_matches('"');
            // Bevy's address of a file that a crate carries.
            let file = file.split_once("://").map_or(file, |(_, path)| path);
            let fits = |known: &&String| *known == file || known.ends_with(&format!("/{file}"));
            let Some(known) = self.files.keys().find(fits) else {
                return Err(format!("there is no file `{file}`"));
            };
            return Ok(PathDestination::Known(joined_path(
                &self.files[known].clone()?,
                &path[1..],
            )));
        }
        for length in (1..=path.len()).rev() {
            if let Some(found) = self.paths.get(&path[..length]) {
                return Ok(PathDestination::Known(joined_path(&found.clone()?, &path[length..])));
            }
        }
        let is_prefix = |known: &&Vec<String>| known.starts_with(path);
        Ok(if self.paths.keys().any(|known| is_prefix(&known)) {
            PathDestination::Prefix
        } else {
            PathDestination::Foreign
        })
    }

    /// The module of exactly that path.
    pub fn module(&self, path: &[String]) -> Result<Option<String>, String> {
        match (self.paths.get(path), path) {
            (Some(found), _) => found.clone().map(Some),
            (None, [file]) if file.starts_with('"') => match self.place(path)? {
                PathDestination::Known(found) => Ok(Some(found)),
                _ => Ok(None),
            },
            _ => Ok(None),
        }
    }

    /// Whether braces of an import hold modules.
    pub fn has_modules(&self, path: &[String], leaf: &ImportLeaf) -> bool {
        leaf.children.iter().any(|child| {
            let whole: Vec<String> = path.iter().chain(&child.path).cloned().collect();
            !child.children.is_empty() || self.paths.keys().any(|known| known.starts_with(&whole))
        })
    }

    /// A warning for each package that is not there.
    pub fn foreign(&self) -> Diagnostics {
        let one = |(name, span): (&String, &Span)| {
            let message = format!("no file here defines what `{name}` has to be");
            Diagnostic::warning(codes::MIGRATED_OTHERWISE, message)
                .at(*span, "imported from a package in WESL")
                .note(format!("help: migrate its sources together with these, or list the package `{name}` in `wesl.toml`"))
        };
        self.foreign.iter().map(one).collect()
    }

    /// The first segments of the paths that no file defines.
    pub fn packages(&self) -> BTreeSet<&str> {
        self.foreign.keys().map(String::as_str).collect()
    }
}

/// The text of every token, in every branch. Comments and imports are not included.
fn compiled_words(text: &str, nodes: &[Node]) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    for node in nodes {
        match node {
            Node::Token(token) => {
                found.insert(text[token.range.clone()].to_owned());
            }
            Node::Choice(choice) => {
                choice
                    .branches
                    .iter()
                    .for_each(|branch| found.extend(compiled_words(text, &branch.nodes)));
            }
            Node::Import(_) | Node::Comment(_) | Node::Gone(_) => {}
        }
    }
    found
}

fn joined_path(module: &str, rest: &[String]) -> String {
    rest.iter().fold(module.to_owned(), |path, segment| format!("{path}::{segment}"))
}

/// `package::folder::file` of a file.
fn place_of(path: &str) -> Result<String, String> {
    let bare = path.rsplit_once('.').map_or(path, |(bare, _)| bare);
    let mut place = "package".to_owned();
    for segment in bare.split('/') {
        let fits = is_word(segment) && !wesl::is_keyword(segment);
        if !fits {
            return Err(format!("`{segment}` of `{path}` is not a name, so nothing can import it"));
        }
        place.push_str("::");
        place.push_str(segment);
    }
    Ok(place)
}
