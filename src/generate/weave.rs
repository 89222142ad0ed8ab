//! The entry points of a program over all its permutations.

use std::collections::{BTreeMap, BTreeSet};

use rayon::prelude::*;

use super::compile::Compiled;
use super::entry::Entry;
use super::lint::Decided;
use super::{Progress, REPORTED};
use crate::bundle::{Digest, Hash, Language, Target};
use crate::compose::{self, Composed, lean};
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::link::Reason;
use crate::permute::{Assignment, Key, ReadTree, Space};

/// Permutations composed before their new texts are compiled: bounds the memory that texts take,
/// which a small batch finds in the processor's caches.
const BATCH: usize = 256;

/// An entry point, compiled for every permutation.
pub struct Woven {
    /// Its name in the bundle.
    pub label: String,
    pub language: Language,
    /// One for each distinct text, in the order of the first permutation that has it.
    pub made: Vec<Digest>,
    /// For each permutation, the index of its text.
    pub text_of: Vec<u32>,
    /// The axes that any composition asked for.
    pub reads: BTreeSet<String>,
    /// How often anything was composed.
    pub compositions: usize,
    /// How the conditions of GLSL came out.
    pub decided: Decided,
    pub warnings: Vec<Diagnostic>,
    /// How many texts a target compiled as a whole for a reason, and the first one's permutation.
    pub whole: BTreeMap<(Reason, Target), (usize, String)>,
}

/// Makes something of each text of a batch; all are new.
pub type Make<'a> = dyn Fn(&[(&Text, &Entry)]) -> Vec<Result<Compiled, Diagnostics>> + 'a;

/// Composes every entry point for every permutation, and makes something of each text, a batch of permutations at a time.
pub fn weave(
    entries: &[Entry],
    space: &Space,
    points: &[Assignment],
    make: &Make<'_>,
    progress: &(dyn Fn(Progress) + Sync),
) -> Result<Vec<Woven>, Diagnostics> {
    let mut looms: Vec<Loom<'_>> = entries.iter().map(Loom::new).collect();
    let stage = entries.first().map_or(String::new(), |entry| entry.program.clone());
    let at = |done| progress(Progress { stage: stage.clone(), done, total: points.len() });
    at(0);
    for start in (0..points.len()).step_by(BATCH) {
        let batch = start..points.len().min(start + BATCH);
        let jobs = compose_batch(&mut looms, space, &points[batch.clone()])?;
        let texts: Vec<_> = jobs.iter().map(|job| (&*job.text, &entries[job.entry])).collect();
        let made = make(&texts)
            .into_iter()
            .zip(&jobs)
            .map(|(made, job)| job.named(made, entries, space, &points[batch.clone()]));
        let made = collect(made.collect())?;
        for ((entry, Compiled { digest, warnings, whole }), job) in made.into_iter().zip(&jobs) {
            let woven = &mut looms[entry].woven;
            woven.made.push(digest);
            woven.warnings.extend(warnings);
            for (target, reason) in whole {
                let example = || space.key(&points[start + job.point]).to_string();
                woven.whole.entry((reason, target)).or_insert_with(|| (0, example())).0 += 1;
            }
        }
        // Texts are many small pieces.
        jobs.into_par_iter().for_each(drop);
        at(batch.end);
    }
    Ok(looms.into_iter().map(|loom| loom.woven).collect())
}

/// A text that no earlier permutation of its entry point had.
struct Job {
    entry: usize,
    /// Index of the permutation in the batch.
    point: usize,
    text: Box<Text>,
}

/// A text as its author reads it, and as it is compiled.
pub struct Text {
    pub composed: Composed,
    pub lean: Composed,
}

impl Job {
    /// What was made of the text; errors and warnings name the permutation.
    fn named(
        &self,
        made: Result<Compiled, Diagnostics>,
        entries: &[Entry],
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

/// Composes whatever earlier batches did not answer, in parallel; several permutations of a batch
/// may compose to one text: to compose is cheaper than to wait for each other.
fn compose_batch(
    looms: &mut [Loom<'_>],
    space: &Space,
    batch: &[Assignment],
) -> Result<Vec<Job>, Diagnostics> {
    let answers = |looms: &[Loom<'_>], point: &Assignment| {
        let settings = space.settings(point);
        looms.iter().map(|loom| loom.find(&settings, space, point)).collect::<Result<Vec<_>, _>>()
    };
    let found = collect(batch.par_iter().map(|point| answers(looms, point)).collect())?;
    let mut jobs = Vec::new();
    for (point, answers) in found.into_iter().enumerate() {
        for (entry, answer) in answers.into_iter().enumerate() {
            jobs.extend(looms[entry].place(answer).map(|text| Job { entry, point, text }));
        }
    }
    // Long ones first would balance better still; neighbours of one entry point are alike, which
    // the caches of the processor and rayon's splitting both like.
    jobs.sort_by_key(|job| job.entry);
    Ok(jobs)
}

/// What is known so far of one entry point.
struct Loom<'a> {
    entry: &'a Entry,
    woven: Woven,
    tree: ReadTree<u32>,
    /// Index by the hash of the text.
    texts: BTreeMap<Hash, u32>,
}

enum Found {
    Known(u32),
    Text { text: Box<Text>, hash: Hash },
}

impl<'a> Loom<'a> {
    fn new(entry: &'a Entry) -> Self {
        let woven = Woven {
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
        Self { entry, woven, tree: ReadTree::default(), texts: BTreeMap::new() }
    }

    fn find(
        &self,
        settings: &crate::permute::Settings,
        space: &Space,
        point: &Assignment,
    ) -> Result<Found, Diagnostics> {
        if let Some(text) = self.tree.get(settings) {
            return Ok(Found::Known(*text));
        }
        let composed = compose::compose(&self.entry.graph, settings, &self.entry.options);
        let composed =
            composed.map_err(|errors| of_permutation(errors, self.entry, &space.key(point)))?;
        let lean = lean(&composed);
        let mut hash = [0; 16];
        hash.copy_from_slice(&blake3::hash(lean.text.as_bytes()).as_bytes()[..16]);
        Ok(Found::Text { text: Box::new(Text { composed, lean }), hash })
    }

    /// Records a permutation's text; gives it back if no earlier one had it.
    fn place(&mut self, found: Found) -> Option<Box<Text>> {
        let (text, hash) = match found {
            Found::Known(index) => {
                self.woven.text_of.push(index);
                return None;
            }
            Found::Text { text, hash } => (text, hash),
        };
        self.woven.compositions += 1;
        self.woven.decided.see(&text.composed.decisions);
        for (name, _) in &text.composed.reads {
            if !self.woven.reads.contains(name) {
                self.woven.reads.insert(name.clone());
            }
        }
        let next = self.texts.len() as u32;
        let index = *self.texts.entry(hash).or_insert(next);
        // A contradiction would only cost a composition that the tree could have saved.
        let _ = self.tree.insert(&text.composed.reads, index);
        self.woven.text_of.push(index);
        if index < next {
            return None;
        }
        let warnings =
            text.composed.warnings.iter().filter(|warning| !self.woven.warnings.contains(warning));
        let new: Vec<_> = warnings.cloned().collect();
        self.woven.warnings.extend(new);
        Some(text)
    }
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
    let same = |known: &Diagnostic| {
        known.code == error.code && known.message == error.message && known.labels == error.labels
    };
    if errors.len() < REPORTED && !errors.iter().any(same) {
        errors.push(error);
    }
}

fn of_permutation(errors: Diagnostics, entry: &Entry, key: &Key) -> Diagnostics {
    errors
        .into_iter()
        .map(|error| error.note(format!("in permutation `{key}` of {}", entry.title())))
        .collect()
}
