//! One entry point over all permutations.

use std::collections::{BTreeMap, BTreeSet};

use rayon::prelude::*;

use super::compile::compile;
use super::entry::Entry;
use super::{Progress, REPORTED};
use crate::bundle::{Target, Unit};
use crate::compose::{self, Composed};
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::permute::{Assignment, Key, ReadTree, Space};

/// Permutations composed before their new texts are compiled: bounds the memory that texts take.
const BATCH: usize = 1024;

/// An entry point, compiled.
pub struct Woven {
    /// Its name in the bundle.
    pub label: String,
    pub language: compose::Language,
    /// One for each distinct text, in the order of the first permutation that has it.
    pub units: Vec<Unit>,
    /// For each permutation, the index of its unit.
    pub unit_of: Vec<u32>,
    /// The axes that any composition asked for.
    pub reads: BTreeSet<String>,
    /// How often anything was composed.
    pub compositions: usize,
    pub warnings: Vec<Diagnostic>,
}

/// Compiles an entry point for every permutation.
pub fn weave(
    entry: &Entry,
    space: &Space,
    points: &[(Key, Assignment)],
    targets: &[Target],
    progress: &(dyn Fn(Progress) + Sync),
) -> Result<Woven, Diagnostics> {
    let mut loom = Loom::new(entry);
    progress(Progress { stage: entry.title(), done: 0, total: points.len() });
    for batch in points.chunks(BATCH) {
        let texts = loom.compose(entry, space, batch)?;
        let units: Vec<Result<(Unit, Diagnostics), Diagnostics>> =
            texts.par_iter().map(|(key, composed)| compiled(entry, key, composed, targets)).collect();
        for (unit, warnings) in collect(units)? {
            loom.woven.units.push(unit);
            loom.woven.warnings.extend(warnings);
        }
        progress(Progress { stage: entry.title(), done: loom.woven.unit_of.len(), total: points.len() });
    }
    Ok(loom.woven)
}

/// A unit with what its author can mend in it; errors and warnings name the permutation.
fn compiled(entry: &Entry, key: &Key, composed: &Composed, targets: &[Target]) -> Result<(Unit, Diagnostics), Diagnostics> {
    let (unit, warnings) =
        compile(composed, &entry.name, targets).map_err(|errors| of_permutation(entry.graph.traced(errors), entry, key))?;
    Ok((unit, of_permutation(entry.graph.own(warnings), entry, key)))
}

/// What is known so far.
struct Loom {
    woven: Woven,
    tree: ReadTree<u32>,
    /// Unit by the hash of its text.
    texts: BTreeMap<[u8; 32], u32>,
}

impl Loom {
    fn new(entry: &Entry) -> Self {
        let woven = Woven {
            label: entry.label.clone(),
            language: entry.language,
            units: Vec::new(),
            unit_of: Vec::new(),
            reads: BTreeSet::new(),
            compositions: 0,
            warnings: Vec::new(),
        };
        Self { woven, tree: ReadTree::default(), texts: BTreeMap::new() }
    }

    /// Gives every permutation of a batch its unit; the texts that are new, in order.
    ///
    /// Settings that no earlier batch answered are composed in parallel, some of them to the same
    /// text: to compose is cheaper than to wait for each other.
    fn compose<'k>(
        &mut self,
        entry: &Entry,
        space: &Space,
        batch: &'k [(Key, Assignment)],
    ) -> Result<Vec<(&'k Key, Composed)>, Diagnostics> {
        let tree = &self.tree;
        let composed: Vec<Result<Found, Diagnostics>> = batch
            .par_iter()
            .map(|(key, point)| {
                let settings = space.settings(point);
                match tree.get(&settings) {
                    Some(unit) => Ok(Found::Unit(*unit)),
                    None => compose::compose(&entry.graph, &settings, &entry.options)
                        .map(|composed| Found::Text(Box::new(composed)))
                        .map_err(|errors| of_permutation(errors, entry, key)),
                }
            })
            .collect();
        let found = collect(composed)?;
        Ok(batch.iter().zip(found).filter_map(|((key, _), found)| self.place(found).map(|composed| (key, composed))).collect())
    }

    /// Records a permutation's unit; its text, if no earlier one had it.
    fn place(&mut self, found: Found) -> Option<Composed> {
        let composed = match found {
            Found::Unit(unit) => {
                self.woven.unit_of.push(unit);
                return None;
            }
            Found::Text(composed) => composed,
        };
        self.woven.compositions += 1;
        self.woven.reads.extend(composed.reads.iter().map(|(name, _)| name.clone()));
        let hash = *blake3::hash(composed.text.as_bytes()).as_bytes();
        let next = self.texts.len() as u32;
        let unit = *self.texts.entry(hash).or_insert(next);
        // A contradiction would only cost a composition that the tree could have saved.
        let _ = self.tree.insert(&composed.reads, unit);
        self.woven.unit_of.push(unit);
        if unit < next {
            return None;
        }
        let new = composed.warnings.iter().filter(|warning| !self.woven.warnings.contains(warning)).cloned().collect::<Vec<_>>();
        self.woven.warnings.extend(new);
        Some(*composed)
    }
}

enum Found {
    Unit(u32),
    Text(Box<Composed>),
}

/// All values, or the first diagnostics of those that failed, each once.
fn collect<T>(results: Vec<Result<T, Diagnostics>>) -> Result<Vec<T>, Diagnostics> {
    let mut values = Vec::with_capacity(results.len());
    let mut errors: Diagnostics = Vec::new();
    for result in results {
        match result {
            Ok(value) => values.push(value),
            Err(found) => found.into_iter().for_each(|error| keep(&mut errors, error)),
        }
    }
    if errors.is_empty() { Ok(values) } else { Err(errors) }
}

/// The same mistake in many permutations is one mistake: the first shows it.
fn keep(errors: &mut Diagnostics, error: Diagnostic) {
    let same = |known: &Diagnostic| known.code == error.code && known.message == error.message && known.labels == error.labels;
    if errors.len() < REPORTED && !errors.iter().any(same) {
        errors.push(error);
    }
}

fn of_permutation(errors: Diagnostics, entry: &Entry, key: &Key) -> Diagnostics {
    errors
        .into_iter()
        .map(|error| error.note(format!("in permutation `{key}` of program `{}`, entry point `{}`", entry.program, entry.label)))
        .collect()
}
