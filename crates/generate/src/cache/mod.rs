//! Keeps results under a hash of all that they depend on, so that a text is compiled once, whoever
//! asks for it and whenever.
//!
//! A key covers everything that a result depends on: the composed text (its comments aside), the
//! entry point, the options, the targets, and the identity of the program ([`Cache::new`]). No
//! time, path or machine enters it. Records are verified when they are read, and a damaged one, or
//! one of another version, counts as absent. A cache that cannot be read or written costs time and
//! nothing else.

mod folder;
mod record;

pub use folder::CacheFolder;
pub use record::MOST_RECORD_BYTES;

use std::collections::BTreeSet;
use std::sync::atomic::{AtomicUsize, Ordering};

use lamplight_bundle::contents::{shortened_hash, to_hex};
use lamplight_bundle::{Conventions, Hash, Target, Unit};
use lamplight_compose::{Composed, Options, Segment};
use lamplight_diagnostic::Diagnostics;
use lamplight_diagnostic::source::SourceId;

/// Bytes by name. Names are made of lower-case letters, digits and `/`.
pub trait Storage: Send + Sync {
    /// The bytes of a name; `None` where there are none.
    fn get(&self, name: &str) -> Result<Option<Vec<u8>>, String>;

    /// Stores bytes as a whole: no reader ever sees a part of them.
    fn put(&self, name: &str, bytes: &[u8]) -> Result<(), String>;
}

/// Storages, the nearest first. What a later one has is copied to the earlier ones.
pub struct Cache {
    build: String,
    storages: Vec<Counted>,
    hits: AtomicUsize,
}

/// A storage with the number of its failures. After too many of them it is not asked any more, so
/// that a server that stopped costs no more time.
struct Counted {
    storage: Box<dyn Storage>,
    failures: AtomicUsize,
}

/// The first words of the names of records.
const KINDS: [&str; 6] = ["costs", "errors", "runs", "units", "validated", "warnings"];

const MOST_FAILURES: usize = 8;

/// Everything that the result of compiling a text depends on.
#[derive(Debug, Clone, Copy)]
pub struct CompileJob<'a> {
    /// What is compiled.
    pub text: &'a str,
    /// The composition that the text stands for. Errors have its places.
    pub composed: &'a Composed,
    /// Name of the entry point.
    pub entry: &'a str,
    /// How the text was composed.
    pub options: &'a Options,
    /// Targets that are asked for, in order.
    pub targets: &'a [Target],
    /// The clip space and the checks of its outputs.
    pub conventions: Conventions,
    /// The version of the program that optimises its outputs, if one does.
    pub optimiser: Option<&'a str>,
}

/// The result of compiling a text: a unit, and the warnings for its author.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CachedUnit {
    /// The outputs.
    pub unit: Unit,
    /// What was warned of when they were made.
    pub warnings: Diagnostics,
}

impl Cache {
    /// A cache in storages that are asked one after the other. `build` is the identity of the
    /// program that computes the results: it changes with the program's code and with that of
    /// everything that it is made of, so that no program finds what another one computed otherwise.
    pub fn new(build: &str, storages: Vec<Box<dyn Storage>>) -> Self {
        let counted = |storage| Counted { storage, failures: AtomicUsize::new(0) };
        Self {
            build: build.to_owned(),
            storages: storages.into_iter().map(counted).collect(),
            hits: AtomicUsize::new(0),
        }
    }

    /// The identity of the program.
    pub fn build(&self) -> &str {
        &self.build
    }

    /// The result of an equal job, if it is known.
    pub fn find(&self, job: CompileJob<'_>) -> Option<Result<CachedUnit, Diagnostics>> {
        let key = unit_key(&self.build, job);
        let diagnostics_of = |kind| {
            let bytes = self.get(kind, diagnostics_key(key, job.composed))?;
            let segments = job.composed.map.segments().iter();
            let known: BTreeSet<SourceId> =
                segments.filter_map(|segment| Some(segment.span?.source)).collect();
            record::decode_diagnostics(&bytes, |id| known.contains(&id))
        };
        let found = match self.get("units", key).and_then(|bytes| record::decode_unit(&bytes)) {
            Some((unit, false)) => Some(Ok(CachedUnit { unit, warnings: Vec::new() })),
            Some((unit, true)) => {
                diagnostics_of("warnings").map(|warnings| Ok(CachedUnit { unit, warnings }))
            }
            None => diagnostics_of("errors").map(Err),
        };
        self.hits.fetch_add(usize::from(found.is_some()), Ordering::Relaxed);
        found
    }

    /// Keeps a result.
    pub fn keep(&self, job: CompileJob<'_>, result: &Result<CachedUnit, Diagnostics>) {
        let key = unit_key(&self.build, job);
        let put_diagnostics = |kind, diagnostics| {
            self.put(
                kind,
                diagnostics_key(key, job.composed),
                record::encode_diagnostics(diagnostics),
            )
        };
        match result {
            Ok(CachedUnit { unit, warnings }) => {
                self.put("units", key, record::encode_unit(unit, !warnings.is_empty()));
                if !warnings.is_empty() {
                    put_diagnostics("warnings", warnings);
                }
            }
            Err(errors) => put_diagnostics("errors", errors),
        }
    }

    /// How many jobs were found in the cache.
    pub fn hits(&self) -> usize {
        self.hits.load(Ordering::Relaxed)
    }

    /// How many reads and writes of the storages failed.
    pub fn failures(&self) -> usize {
        self.storages.iter().map(|storage| storage.failures.load(Ordering::Relaxed)).sum()
    }

    pub fn get(&self, kind: &str, key: Hash) -> Option<Vec<u8>> {
        let name = record_name(kind, key);
        for (index, storage) in self.storages.iter().enumerate() {
            let Some(record) = storage.get(&name) else { continue };
            if let Some(payload) = record::open_record(&name, &record) {
                self.storages[..index].iter().for_each(|nearer| nearer.put(&name, &record));
                return Some(payload);
            }
        }
        None
    }

    pub fn put(&self, kind: &str, key: Hash, payload: Option<Vec<u8>>) {
        let name = record_name(kind, key);
        let Some(record) = payload.and_then(|payload| record::seal_record(&name, &payload)) else {
            return;
        };
        self.storages.iter().for_each(|storage| storage.put(&name, &record));
    }
}

impl Counted {
    fn get(&self, name: &str) -> Option<Vec<u8>> {
        self.count(|storage| storage.get(name)).flatten()
    }

    fn put(&self, name: &str, bytes: &[u8]) {
        self.count(|storage| storage.put(name, bytes));
    }

    fn count<T>(&self, ask: impl FnOnce(&dyn Storage) -> Result<T, String>) -> Option<T> {
        if self.failures.load(Ordering::Relaxed) >= MOST_FAILURES {
            return None;
        }
        let answer = ask(&*self.storage);
        self.failures.fetch_add(usize::from(answer.is_err()), Ordering::Relaxed);
        answer.ok()
    }
}

/// The name of a record. Two letters of the hash name a folder, so that no folder grows too large.
fn record_name(kind: &str, key: Hash) -> String {
    let hex = to_hex(&key);
    format!("{kind}/{}/{}", &hex[..2], &hex[2..])
}

fn unit_key(build: &str, job: CompileJob<'_>) -> Hash {
    let CompileJob { text, composed, entry, options, targets, conventions, optimiser } = job;
    let names: Vec<&str> = targets.iter().map(|target| target.name()).collect();
    let rest = format!(
        "{:?} {:?} {options:?} {entry:?} {names:?} {conventions:?} {optimiser:?}",
        composed.language, composed.stage
    );
    hash_parts(&["unit", build, &rest, text])
}

/// The key of a unit's diagnostics. They have places, so it covers where each part of the text came
/// from.
fn diagnostics_key(unit: Hash, composed: &Composed) -> Hash {
    let mut places = Vec::new();
    for Segment { start, span, verbatim } in composed.map.segments() {
        let from = span.map_or([u32::MAX; 3], |span| [span.source.0, span.start, span.end]);
        for number in [*start, from[0], from[1], from[2], u32::from(*verbatim)] {
            places.extend_from_slice(&number.to_le_bytes());
        }
    }
    hash_bytes(&[b"diagnostics", &unit, composed.text.as_bytes(), &places])
}

/// 128 bits of a hash. Each part is hashed with its length, so parts cannot run into each other.
pub fn hash_parts(parts: &[&str]) -> Hash {
    let parts: Vec<&[u8]> = parts.iter().map(|part| part.as_bytes()).collect();
    hash_bytes(&parts)
}

fn hash_bytes(parts: &[&[u8]]) -> Hash {
    let mut hasher = blake3::Hasher::new();
    for part in parts {
        hasher.update(&(part.len() as u64).to_le_bytes());
        hasher.update(part);
    }
    shortened_hash(&hasher.finalize())
}
