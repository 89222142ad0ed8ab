//! Parsed texts, and what their names mean, that are kept from one reading of a package to the
//! next, as editors need it: after a keystroke, all files but one have the text that they had
//! before.

use std::sync::Arc;

use rustc_hash::FxHashMap;

use super::replay::Resolution;
use crate::resolve::{Packages, Scope};
use lamplight_diagnostic::source::SourceId;
use lamplight_syntax::wesl::{Module, Name, Names, parse_for_editor};

/// A text that was not read again in so many readings is forgotten.
const READINGS: u64 = 64;

/// The most identifiers that are kept. Each state of a text that is being typed may add some, so
/// there can be many more than the package has.
const NAMES: usize = 1 << 20;

/// A parsed text, with what it declares.
#[derive(Debug, Clone)]
pub struct ParsedModule {
    pub module: Arc<Module>,
    /// Indices of items by name, in the order of the text.
    pub sets: Arc<FxHashMap<Name, Vec<u32>>>,
    /// Indices of imports, by the name that they bring into scope.
    pub aliases: Arc<FxHashMap<Name, Vec<usize>>>,
}

impl ParsedModule {
    pub fn new(module: Arc<Module>) -> Self {
        let mut sets: FxHashMap<Name, Vec<u32>> = FxHashMap::default();
        let named = module.items.iter().enumerate();
        for (index, item) in named.filter(|(_, item)| item.name != Name::UNDERSCORE) {
            sets.entry(item.name).or_default().push(index as u32);
        }
        let mut aliases: FxHashMap<Name, Vec<usize>> = FxHashMap::default();
        for (index, import) in module.imports.iter().enumerate() {
            aliases.entry(import.alias).or_default().push(index);
        }
        Self { module, sets: Arc::new(sets), aliases: Arc::new(aliases) }
    }
}

/// Identifies a module: the root file of the reading, the number of the module's package, and its
/// path in that package.
pub type ModuleKey = (String, usize, Vec<String>);

/// Parsed texts by their content, the identifiers that all of them share, and the resolutions of
/// modules.
#[derive(Debug, Default)]
pub struct KeptModules {
    /// `None` during a reading, which has taken them, and after a reading that ended early.
    names: Option<Arc<Names>>,
    modules: FxHashMap<Arc<str>, (ParsedModule, u64)>,
    resolutions: FxHashMap<ModuleKey, (Arc<Resolution>, u64)>,
    /// The names of the package and of its dependencies, which are in labels, and what each may
    /// import. Paths start with names of the latter.
    packages: (Vec<String>, Vec<Scope>),
    reading: u64,
}

impl KeptModules {
    /// Begins a reading; gives the identifiers to it.
    pub(super) fn begin(&mut self, packages: &Packages) -> Names {
        self.reading += 1;
        let oldest = self.reading.saturating_sub(READINGS);
        self.modules.retain(|_, (_, last)| *last >= oldest);
        self.resolutions.retain(|_, (_, last)| *last >= oldest);
        let names = packages.all().map(|package| package.name.clone()).collect();
        let packages = (names, packages.scopes().to_vec());
        if packages != self.packages {
            self.resolutions.clear();
            self.packages = packages;
        }
        match self.names.take().filter(|names| names.len() <= NAMES) {
            Some(names) => Arc::unwrap_or_clone(names),
            // The parsed texts refer to identifiers by numbers that are no longer valid.
            None => {
                self.modules.clear();
                self.resolutions.clear();
                Names::default()
            }
        }
    }

    /// Ends a reading.
    pub(super) fn end(&mut self, names: Arc<Names>) {
        self.names = Some(names);
    }

    /// The parsed text. It may have been parsed before, for this file or for another one with the
    /// same text.
    pub(super) fn parse(
        &mut self,
        source: SourceId,
        text: Arc<str>,
        names: &mut Names,
    ) -> ParsedModule {
        let reading = self.reading;
        if let Some((parsed, last)) = self.modules.get_mut(&text) {
            *last = reading;
            return parsed.clone();
        }
        let module = parse_for_editor(source, Arc::clone(&text), names);
        let parsed = ParsedModule::new(Arc::new(module));
        self.modules.insert(text, (parsed.clone(), reading));
        parsed
    }

    /// The resolution of a module that was kept last.
    pub(super) fn resolution(&mut self, key: &ModuleKey) -> Option<Arc<Resolution>> {
        let (resolution, last) = self.resolutions.get_mut(key)?;
        *last = self.reading;
        Some(Arc::clone(resolution))
    }

    /// Keeps the resolution of a module. With `None`, which means that it holds only for this
    /// reading, an earlier one is dropped.
    pub(super) fn keep_resolution(&mut self, key: ModuleKey, resolution: Option<Resolution>) {
        match resolution {
            Some(resolution) => {
                self.resolutions.insert(key, (Arc::new(resolution), self.reading));
            }
            None => drop(self.resolutions.remove(&key)),
        }
    }
}
