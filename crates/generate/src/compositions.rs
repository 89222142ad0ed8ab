//! Composes the entry points of a program for all its permutations.

use std::collections::{BTreeMap, BTreeSet};

use rayon::prelude::*;

use super::compile::Compiled;
use super::entry::ShaderEntry;
use super::lint::Decided;
use super::shader::add_numbers;
use super::{Progress, REPORTED};
use lamplight_bundle::{Digest, Hash, Language, Target};
use lamplight_compose::{self as compose, Composed, Leaner};
use lamplight_diagnostic::{Diagnostic, Diagnostics};
use lamplight_link::Reason;
use lamplight_permute::{Assignment, Key, ReadTree, Space};

/// Permutations that are composed before their new texts are compiled. It bounds the memory for
/// texts; a small batch also stays in the processor's caches.
const BATCH: usize = 256;

/// What one entry point became over all permutations.
pub struct EntryResult {
    /// Its name in the bundle.
    pub label: String,
    pub language: Language,
    /// The digest of each distinct text's unit, in the order in which the texts first occurred.
    pub made: Vec<Digest>,
    /// For each permutation, the index of its text.
    pub text_of: Vec<u32>,
    /// The axes that any composition asked for.
    pub reads: BTreeSet<String>,
    /// How many compositions were made.
    pub compositions: usize,
    /// How the conditions of GLSL came out.
    pub decided: Decided,
    pub warnings: Vec<Diagnostic>,
    /// For a reason and a target, how many texts were compiled as a whole, and the first such
    /// permutation.
    pub whole: BTreeMap<(Reason, Target), (usize, String)>,
}

/// What is done with the new texts of a batch: they are compiled, or only counted. There is one
/// result for each text.
pub type Make<'a> =
    dyn Fn(&[(&ComposedForms, &ShaderEntry)]) -> Vec<Result<Compiled, Diagnostics>> + 'a;

/// Composes every entry point for every permutation, a batch of permutations at a time, and passes
/// the new texts of each batch to `make`.
pub fn compose_all(
    entries: &[ShaderEntry],
    space: &Space,
    points: &[Assignment],
    make: &Make<'_>,
    progress: &(dyn Fn(Progress) + Sync),
) -> Result<Vec<EntryResult>, Diagnostics> {
    let mut known: Vec<EntryState<'_>> = entries.iter().map(EntryState::new).collect();
    let stage = entries.first().map_or(String::new(), |entry| entry.program.clone());
    let at = |done| progress(Progress { stage: stage.clone(), done, total: points.len() });
    at(0);
    for start in (0..points.len()).step_by(BATCH) {
        let batch = start..points.len().min(start + BATCH);
        let jobs = compose_batch(&mut known, space, &points[batch.clone()])?;
        let texts: Vec<_> = jobs.iter().map(|job| (&*job.text, &entries[job.entry])).collect();
        let made = make(&texts)
            .into_iter()
            .zip(&jobs)
            .map(|(made, job)| job.named(made, entries, space, &points[batch.clone()]));
        let made = collect_values(made.collect())?;
        for ((entry, Compiled { digest, warnings, whole }), job) in made.into_iter().zip(&jobs) {
            let result = &mut known[entry].result;
            result.made.push(digest);
            result.warnings.extend(warnings);
            for (target, reason) in whole {
                let example = || space.key(&points[start + job.point]).to_string();
                result.whole.entry((reason, target)).or_insert_with(|| (0, example())).0 += 1;
            }
        }
        // Freed in parallel, since a text consists of many small allocations.
        jobs.into_par_iter().for_each(drop);
        at(batch.end);
    }
    Ok(known.into_iter().map(|entry| entry.result).collect())
}

/// A text that no earlier permutation of its entry point had.
struct TextJob {
    entry: usize,
    /// Index of the permutation in the batch.
    point: usize,
    text: Box<ComposedForms>,
}

/// A text in two forms: as its author reads it, and as it is compiled.
pub struct ComposedForms {
    pub composed: Composed,
    pub lean: Composed,
}

impl TextJob {
    /// What was made of the text, with the permutation named in errors and warnings.
    fn named(
        &self,
        made: Result<Compiled, Diagnostics>,
        entries: &[ShaderEntry],
        space: &Space,
        batch: &[Assignment],
    ) -> Result<(usize, Compiled), Diagnostics> {
        let entry = &entries[self.entry];
        let named =
            |diagnostics| of_permutation(diagnostics, entry, &space.key(&batch[self.point]));
        let made = made.map_err(|errors| named(entry.graph.traced(errors)))?;
        Ok((self.entry, Compiled { warnings: named(entry.graph.own(made.warnings)), ..made }))
    }
}

/// Composes in parallel whatever earlier batches did not answer. Several permutations of a batch
/// may compose to one text: composing it again costs less than waiting for each other.
fn compose_batch(
    known: &mut [EntryState<'_>],
    space: &Space,
    batch: &[Assignment],
) -> Result<Vec<TextJob>, Diagnostics> {
    let answers = |known: &[EntryState<'_>], point: &Assignment| {
        let settings = space.settings(point);
        known.iter().map(|entry| entry.find(&settings, space, point)).collect::<Result<Vec<_>, _>>()
    };
    let found = collect_values(batch.par_iter().map(|point| answers(known, point)).collect())?;
    let mut jobs = Vec::new();
    for (point, answers) in found.into_iter().enumerate() {
        for (entry, answer) in answers.into_iter().enumerate() {
            jobs.extend(known[entry].place(answer).map(|text| TextJob { entry, point, text }));
        }
    }
    // Sorted by entry point, since neighbours are alike: that suits the processor's caches and the
    // way in which rayon splits work. Long texts first would balance the load even better.
    jobs.sort_by_key(|job| job.entry);
    Ok(jobs)
}

/// What is known of one entry point so far.
struct EntryState<'a> {
    entry: &'a ShaderEntry,
    result: EntryResult,
    tree: ReadTree<u32>,
    leaner: Leaner,
    /// The index of each text, by its hash.
    texts: BTreeMap<Hash, u32>,
}

enum FoundText {
    Known(u32),
    Text { text: Box<ComposedForms>, hash: Hash },
}

impl<'a> EntryState<'a> {
    fn new(entry: &'a ShaderEntry) -> Self {
        let result = EntryResult {
            label: entry.label.clone(),
            language: entry.language,
            made: Vec::new(),
            text_of: Vec::new(),
            reads: BTreeSet::new(),
            compositions: 0,
            decided: Decided::default(),
            warnings: Vec::new(),
            whole: BTreeMap::new(),
        };
        let (tree, leaner) = (ReadTree::default(), Leaner::new(entry.language));
        Self { entry, result, tree, leaner, texts: BTreeMap::new() }
    }

    fn find(
        &self,
        settings: &lamplight_permute::Settings,
        space: &Space,
        point: &Assignment,
    ) -> Result<FoundText, Diagnostics> {
        if let Some(text) = self.tree.get(settings) {
            return Ok(FoundText::Known(*text));
        }
        let composed = compose::compose(&self.entry.graph, settings, &self.entry.options);
        let mut composed =
            composed.map_err(|errors| of_permutation(errors, self.entry, &space.key(point)))?;
        let mut lean = self.leaner.lean(&composed);
        add_numbers(&mut composed, &self.entry.numbers);
        add_numbers(&mut lean, &self.entry.numbers);
        let mut hash = [0; 16];
        hash.copy_from_slice(&blake3::hash(lean.text.as_bytes()).as_bytes()[..16]);
        Ok(FoundText::Text { text: Box::new(ComposedForms { composed, lean }), hash })
    }

    /// Records a permutation's text, and returns it if no earlier permutation had it.
    fn place(&mut self, found: FoundText) -> Option<Box<ComposedForms>> {
        let (text, hash) = match found {
            FoundText::Known(index) => {
                self.result.text_of.push(index);
                return None;
            }
            FoundText::Text { text, hash } => (text, hash),
        };
        self.result.compositions += 1;
        self.result.decided.see(&text.composed.decisions);
        for (name, _) in &text.composed.reads {
            if !self.result.reads.contains(name) {
                self.result.reads.insert(name.clone());
            }
        }
        let next = self.texts.len() as u32;
        let index = *self.texts.entry(hash).or_insert(next);
        // A contradiction would only cost one composition that the tree could have saved.
        let _ = self.tree.insert(&text.composed.reads, index);
        self.result.text_of.push(index);
        if index < next {
            return None;
        }
        let warnings =
            text.composed.warnings.iter().filter(|warning| !self.result.warnings.contains(warning));
        let new: Vec<_> = warnings.cloned().collect();
        self.result.warnings.extend(new);
        Some(text)
    }
}

/// All values, or the first diagnostics of those that failed, each once.
fn collect_values<T>(results: Vec<Result<T, Diagnostics>>) -> Result<Vec<T>, Diagnostics> {
    let mut values = Vec::with_capacity(results.len());
    let mut errors: Diagnostics = Vec::new();
    for result in results {
        match result {
            Ok(value) => values.push(value),
            Err(found) => found.into_iter().for_each(|error| keep_new(&mut errors, error)),
        }
    }
    if errors.is_empty() { Ok(values) } else { Err(errors) }
}

/// Adds a diagnostic unless an equal one is there already. So a mistake that many permutations have
/// is reported only for the first of them.
fn keep_new(errors: &mut Diagnostics, error: Diagnostic) {
    let same = |known: &Diagnostic| {
        known.code == error.code && known.message == error.message && known.labels == error.labels
    };
    if errors.len() < REPORTED && !errors.iter().any(same) {
        errors.push(error);
    }
}

fn of_permutation(errors: Diagnostics, entry: &ShaderEntry, key: &Key) -> Diagnostics {
    errors
        .into_iter()
        .map(|error| error.note(format!("in permutation `{key}` of {}", entry.title())))
        .collect()
}
