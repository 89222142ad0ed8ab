//! Resolves a module as it was resolved in an earlier reading, where nothing that this depends on
//! has changed.
//!
//! What the names of a module mean depends on its own text and on the answers to two questions:
//! which module a path leads to, and whether that module has an item. Both are asked again, in the
//! same order. If all answers are those of the earlier reading, then so is the result. Modules with
//! errors, with warnings, or with constants are resolved anew, since these are numbered over all
//! modules, and so are those that asked what files a folder has.

use std::ops::Range;
use std::sync::Arc;

use super::graph::{Candidate, PathTarget};
use super::load::Loader;
use lamplight_diagnostic::Diagnostic;
use lamplight_diagnostic::source::Span;
use lamplight_syntax::wesl::{Module, Name};

/// A module that was asked for, and the answer.
#[derive(Debug)]
struct ModuleRequest {
    package: usize,
    path: Vec<Name>,
    /// The place of the path that asks, in the module that is resolved.
    place: Range<u32>,
    answer: Option<u32>,
}

/// What the resolving of a module asked and found.
#[derive(Debug)]
pub struct Resolution {
    module: Arc<Module>,
    node: u32,
    asks: Vec<ModuleRequest>,
    /// The items that were found in other modules.
    items: Vec<(u32, Name)>,
    /// The items that were not found, so that the name is that of a module.
    lacks: Vec<(u32, Name)>,
    steps: u64,
    imports: Arc<Vec<Vec<PathTarget>>>,
    bindings: Arc<Vec<Vec<Candidate>>>,
}

/// What a loader notes while it resolves a module.
#[derive(Debug, Default)]
pub struct LoadNotes {
    asks: Vec<ModuleRequest>,
    /// The items that were not found in a module.
    pub lacks: Vec<(u32, Name)>,
    /// Whether a module could not be read, or the files of a folder were asked for. Then the result
    /// is not kept.
    pub is_open: bool,
    failures: usize,
    steps: u64,
}

impl Loader<'_> {
    /// Resolves a module, as in an earlier reading where that gives the same.
    pub(super) fn resolve(&mut self, node: u32) {
        let here = &self.nodes[node as usize];
        let key = (self.root.clone(), here.package, here.path.clone());
        let known = self.kept.as_mut().and_then(|kept| kept.resolution(&key));
        if known.is_some_and(|known| self.replay(node, &known)) {
            return;
        }
        self.begin_notes();
        self.resolve_anew(node);
        let resolution = self.resolution(node);
        if let Some(kept) = &mut self.kept {
            kept.keep_resolution(key, resolution);
        }
    }

    /// The module of a package at a path, which is noted.
    pub(super) fn ask_module(
        &mut self,
        package: usize,
        path: &[Name],
        asker: Span,
    ) -> Result<Option<u32>, Diagnostic> {
        let answer = self.module(package, path, asker);
        if self.kept.is_some() {
            match &answer {
                Ok(answer) => self.notes.asks.push(ModuleRequest {
                    package,
                    path: path.to_vec(),
                    place: asker.start..asker.end,
                    answer: *answer,
                }),
                Err(_) => self.notes.is_open = true,
            }
        }
        answer
    }

    /// Begins to note what resolving asks.
    fn begin_notes(&mut self) {
        let (failures, steps) = (self.failures.len(), self.spent.get());
        self.notes = LoadNotes { failures, steps, ..LoadNotes::default() };
    }

    /// What was noted, if the module may be resolved like this again.
    fn resolution(&mut self, node: u32) -> Option<Resolution> {
        let notes = std::mem::take(&mut self.notes);
        let here = &self.nodes[node as usize];
        let is_plain = !notes.is_open
            && notes.failures == self.failures.len()
            && here.lints.is_empty()
            && here.broken_imports.is_empty()
            && here.passed.is_empty()
            && here.duplicates.is_empty();
        let bound = here.bindings.iter().flatten().map(|candidate| candidate.target);
        let mut items = Vec::new();
        for target in here.imports.iter().flatten().copied().chain(bound) {
            match target {
                PathTarget::Items { node: other, name } if other != node => {
                    items.push((other, name))
                }
                PathTarget::Items { .. } | PathTarget::Module => {}
                PathTarget::Constant(_) | PathTarget::Failed(_) => return None,
            }
        }
        items.sort_unstable();
        items.dedup();
        is_plain.then(|| Resolution {
            module: here.module.shared(),
            node,
            asks: notes.asks,
            items,
            lacks: notes.lacks,
            steps: self.spent.get() - notes.steps,
            imports: Arc::clone(&here.imports),
            bindings: Arc::clone(&here.bindings),
        })
    }

    /// Resolves a module as before; false if something that this depends on has changed.
    fn replay(&mut self, node: u32, known: &Resolution) -> bool {
        let here = &self.nodes[node as usize];
        if known.node != node || !Arc::ptr_eq(&known.module, &here.module.shared()) {
            return false;
        }
        for ask in &known.asks {
            let place = self.nodes[node as usize].module.span(ask.place.clone());
            match self.module(ask.package, &ask.path, place) {
                Ok(answer) if answer == ask.answer => {}
                _ => return false,
            }
        }
        let here = &self.nodes[node as usize];
        let shows = |(other, name): &(u32, Name)| {
            self.nodes.get(*other as usize).is_some_and(|node| node.shows_name(*name, here))
        };
        let has = |(other, name): &(u32, Name)| {
            self.nodes.get(*other as usize).is_some_and(|node| node.sets.contains_key(name))
        };
        // What a module passes on is never kept, but a module may have begun to pass on something.
        let passes = |(other, name): &(u32, Name)| {
            self.nodes.get(*other as usize).is_some_and(|node| {
                let mut imports = node.aliases.get(name).into_iter().flatten();
                imports.any(|index| node.module.imports[*index].is_public)
            })
        };
        if !known.items.iter().all(shows)
            || known.lacks.iter().any(has)
            || known.items.iter().chain(&known.lacks).any(passes)
        {
            return false;
        }
        // The steps count as if the module were resolved anew, so what is kept does not affect
        // limits.
        self.step(known.steps as usize);
        let here = &mut self.nodes[node as usize];
        here.imports = Arc::clone(&known.imports);
        here.bindings = Arc::clone(&known.bindings);
        true
    }
}
