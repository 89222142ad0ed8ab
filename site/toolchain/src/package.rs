//! The package of a request: the user's files, or the library itself.

use std::cell::{OnceCell, RefCell};
use std::collections::BTreeMap;
use std::rc::Rc;

use lamplight::bundle::Language;
use lamplight::diagnostic::Diagnostics;
use lamplight::permute::Setting;
use lamplight::permute::manifest::{self, Manifest};
use lamplight::project::{self, MANIFEST};
use lamplight::resolve::wesl::{self, KeptModules as Parsed};
use lamplight::resolve::{self, Graph, Packages};
use lamplight::source::{Memory, Package, SourceSet};
use serde::{Deserialize, Serialize};
use tsify::Tsify;

/// Texts by path.
pub type Files = BTreeMap<String, String>;

/// The value of an axis or a flag.
#[derive(Clone, PartialEq, Serialize, Deserialize, Tsify)]
#[serde(untagged)]
pub enum Value {
    Bool(bool),
    Number(f64),
    Name(String),
}

impl Value {
    pub fn setting(&self) -> Setting {
        match self {
            Self::Bool(value) => Setting::Bool(*value),
            Self::Number(value) => Setting::Int(*value as i64),
            Self::Name(name) => Setting::parse(name),
        }
    }

    pub fn of(setting: &Setting) -> Self {
        match setting {
            Setting::Bool(value) => Self::Bool(*value),
            Setting::Int(value) => Self::Number(*value as f64),
            other => Self::Name(other.to_string()),
        }
    }
}

/// The package and what it may import. Every package may import the library.
pub fn packages(files: Option<&Files>) -> Packages {
    match files {
        None => project::library_packages(),
        Some(files) => Packages::new(
            Package { name: "package".to_owned(), files: Box::new(Memory(files.clone())) },
            vec![project::library_package()],
        ),
    }
}

/// A manifest with the texts that it points into.
type ReadManifest = Rc<(SourceSet, Manifest)>;

/// A manifest. It is read again only after it has changed.
pub enum Held {
    Read(ReadManifest),
    None,
}

impl Held {
    pub fn get(&self) -> Option<&Manifest> {
        match self {
            Self::Read(kept) => Some(&kept.1),
            Self::None => None,
        }
    }
}

thread_local! {
    static LIBRARY_MANIFEST: OnceCell<ReadManifest> = const { OnceCell::new() };
    /// The text of the last manifest of the user's, and the manifest.
    static OWN_MANIFEST: RefCell<Option<(String, ReadManifest)>> = const { RefCell::new(None) };
    /// Parsed texts: after a keystroke, all but one are what they were.
    static PARSED: RefCell<Parsed> = RefCell::default();
    static GRAPHS: RefCell<BTreeMap<String, Kept>> = const { RefCell::new(BTreeMap::new()) };
}

/// A graph of the library with the texts that it points into.
type Kept = Rc<(SourceSet, Graph)>;

/// The manifest of the package, if it has one.
pub fn manifest(files: Option<&Files>, sources: &mut SourceSet) -> Result<Held, Diagnostics> {
    let Some(files) = files else { return library_manifest(sources) };
    let Some(text) = files.get(MANIFEST) else { return Ok(Held::None) };
    OWN_MANIFEST.with_borrow_mut(|kept| {
        if let Some((_, found)) = kept.as_ref().filter(|(known, _)| known == text) {
            *sources = found.0.clone();
            return Ok(Held::Read(found.clone()));
        }
        let id = sources.add(MANIFEST, text.clone());
        let found = Rc::new((sources.clone(), manifest::parse(sources, id)?));
        *kept = Some((text.clone(), found.clone()));
        Ok(Held::Read(found))
    })
}

fn library_manifest(sources: &mut SourceSet) -> Result<Held, Diagnostics> {
    LIBRARY_MANIFEST.with(|kept| {
        if kept.get().is_none() {
            let found = project::library_manifest().map_err(|(texts, problems)| {
                *sources = texts;
                problems
            })?;
            let _ = kept.set(Rc::new(found));
        }
        let found = kept.get().cloned().ok_or_else(Vec::new)?;
        *sources = found.0.clone();
        Ok(Held::Read(found))
    })
}

/// The graph of a root file. Those of the library never change, so they are read only once.
pub fn graph(
    files: Option<&Files>,
    root: &str,
    language: Language,
    sources: &mut SourceSet,
) -> Result<Kept, Diagnostics> {
    let packages = packages(files);
    let load = |sources: &mut SourceSet| resolve::load(sources, &packages, root, language);
    if files.is_some() {
        let graph = match language {
            Language::Wesl => PARSED
                .with_borrow_mut(|kept| wesl::load_kept(sources, &packages, root, kept))
                .map(Graph::Wesl)?,
            Language::Glsl => load(sources)?,
        };
        return Ok(Rc::new((SourceSet::default(), graph)));
    }
    let found = GRAPHS.with_borrow(|kept| kept.get(root).cloned());
    if let Some(found) = found {
        *sources = found.0.clone();
        return Ok(found);
    }
    let graph = load(sources)?;
    let made = Rc::new((sources.clone(), graph));
    GRAPHS.with_borrow_mut(|kept| kept.insert(root.to_owned(), made.clone()));
    Ok(made)
}
