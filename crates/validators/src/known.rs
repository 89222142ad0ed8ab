//! Remembers which outputs passed.

use std::collections::BTreeSet;

use lamplight_bundle::{Hash, Target};
use lamplight_generate::cache::{Cache, hash_parts};

const KIND: &str = "judged";

/// If more names than this are stored, all are forgotten, and their outputs are judged again.
/// Otherwise a bundle that changes often would collect names for ever.
const MOST: usize = 200_000;

/// The outputs of one target that passed, by their names, which are hashes of their content.
pub struct KnownOutputs {
    key: Hash,
    before: usize,
    pub names: BTreeSet<String>,
}

impl KnownOutputs {
    /// The outputs that judges of these versions accepted.
    pub fn load(cache: Option<&Cache>, target: Target, versions: &str) -> Self {
        let key = hash_parts(&[KIND, target.name(), versions]);
        let text = cache.and_then(|cache| cache.get(KIND, key)).unwrap_or_default();
        let text = String::from_utf8_lossy(&text);
        let mut names: BTreeSet<String> = text.lines().map(str::to_owned).collect();
        if names.len() > MOST {
            names.clear();
        }
        Self { key, before: names.len(), names }
    }

    /// Stores them, if there are new ones.
    pub fn keep(&self, cache: Option<&Cache>) {
        let lines: Vec<&str> = self.names.iter().map(String::as_str).collect();
        if self.names.len() != self.before
            && let Some(cache) = cache
        {
            cache.put(KIND, self.key, Some(lines.join("\n").into_bytes()));
        }
    }
}
