//! What the files say that declare a package: its manifest and its features. Reading these takes
//! longer than reading a module, and every key asks for them.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use lamplight_compose::project;
use lamplight_diagnostic::Diagnostics;
use lamplight_diagnostic::source::SourceSet;
use lamplight_permute::Manifest;
use lamplight_permute::manifest::Features;

/// What a package declares.
#[derive(Debug, Clone)]
pub struct Declared {
    /// The texts of the files that declare it. Places of the others are in these.
    pub sources: SourceSet,
    pub manifest: Option<Arc<Manifest>>,
    pub features: Features,
    /// Errors and warnings of these files.
    pub problems: Diagnostics,
    has_errors: bool,
}

/// What packages declared when they were opened last, by root folder.
#[derive(Debug, Default)]
pub struct DeclaredPackages(Mutex<BTreeMap<PathBuf, Arc<Declared>>>);

impl DeclaredPackages {
    /// What a package declares. `sources` has the files that were read for its dependencies. What
    /// is known is taken while every file has the text that it had.
    pub fn or_read(&self, root: &Path, sources: SourceSet) -> Arc<Declared> {
        let mut known = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(declared) = known.get(root).filter(|then| then.is_current(root, &sources)) {
            return Arc::clone(declared);
        }
        let declared = Arc::new(Declared::read(root, sources));
        known.insert(root.to_owned(), Arc::clone(&declared));
        declared
    }
}

impl Declared {
    fn read(root: &Path, mut sources: SourceSet) -> Self {
        let mut problems = Diagnostics::new();
        let manifest = project::manifest(root, &mut sources).unwrap_or_else(|more| {
            problems.extend(more);
            None
        });
        let features = match &manifest {
            Some(manifest) => manifest.features.clone(),
            None => project::features(root, &mut sources).unwrap_or_else(|more| {
                problems.extend(more);
                Features::default()
            }),
        };
        let has_errors = !problems.is_empty();
        problems.extend(manifest.iter().flat_map(|manifest| manifest.warnings.iter().cloned()));
        Self { sources, manifest: manifest.map(Arc::new), features, problems, has_errors }
    }

    /// Whether reading again would give the same. After an error other files may have been looked
    /// for, so it is always read again then.
    fn is_current(&self, root: &Path, fresh: &SourceSet) -> bool {
        let before = fresh.iter().count();
        let is_same = fresh
            .iter()
            .zip(self.sources.iter())
            .all(|((_, new), (_, old))| new.path == old.path && new.text == old.text);
        let mut others = self.sources.iter().skip(before);
        !self.has_errors
            && before <= self.sources.iter().count()
            && is_same
            && self.manifest.is_some() == project::manifest_of(root).is_some()
            && others.all(|(_, source)| {
                fs::read_to_string(&source.path).is_ok_and(|text| *text == *source.text)
            })
    }
}
