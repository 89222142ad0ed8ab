//! Remembers which outputs and lines passed.

use std::collections::BTreeSet;

use lamplight_bundle::{Hash, Target};
use lamplight_generate::cache::{Cache, hash_parts};

use crate::Extent;

pub const KIND: &str = "validated";

/// If more names or lines than this are stored, all are forgotten, and their outputs are validated
/// again. Otherwise a bundle that changes often would collect them for ever.
const MOST: usize = 200_000;

/// What stands before the hash of a line, where names of outputs and hashes are listed.
const LINE: char = '=';

/// The outputs of one target that passed, by their names, which are hashes of their content.
pub struct KnownOutputs {
    key: Hash,
    before: usize,
    pub names: BTreeSet<String>,
    /// Hashes of the lines that passed, for [`Extent::Lines`].
    pub lines: BTreeSet<u64>,
}

impl KnownOutputs {
    /// What validators of these versions accepted.
    pub fn load(cache: Option<&Cache>, target: Target, extent: Extent, versions: &str) -> Self {
        let whole = [KIND, target.name(), versions];
        let key = match extent {
            Extent::Lines => hash_parts(&[KIND, target.name(), versions, extent.name()]),
            Extent::All | Extent::Nothing => hash_parts(&whole),
        };
        let text = cache.and_then(|cache| cache.get(KIND, key)).unwrap_or_default();
        let text = String::from_utf8_lossy(&text);
        let (mut names, mut lines) = (BTreeSet::new(), BTreeSet::new());
        for entry in text.lines() {
            match entry.strip_prefix(LINE) {
                Some(hash) => lines.extend(u64::from_str_radix(hash, 16)),
                None => _ = names.insert(entry.to_owned()),
            }
        }
        if names.len().max(lines.len()) > MOST {
            (names, lines) = (BTreeSet::new(), BTreeSet::new());
        }
        // Outputs that passed as a whole need no second look at their lines.
        if extent == Extent::Lines {
            names.extend(Self::load(cache, target, Extent::All, versions).names);
        }
        Self { key, before: names.len(), names, lines }
    }

    /// Stores them, if there are new ones.
    pub fn keep(&self, cache: Option<&Cache>) {
        let lines = self.lines.iter().map(|hash| format!("{LINE}{hash:016x}"));
        let entries: Vec<String> = self.names.iter().cloned().chain(lines).collect();
        if self.names.len() != self.before
            && let Some(cache) = cache
        {
            cache.put(KIND, self.key, Some(entries.join("\n").into_bytes()));
        }
    }
}
