//! What passed before.

use std::collections::BTreeSet;

use crate::bundle::{Hash, Target};
use crate::cache::{Cache, hash};

const KIND: &str = "judged";

/// Names after which only those of the last run are kept: a bundle that changes often would
/// collect them for ever.
const MOST: usize = 200_000;

/// Outputs of one target that passed, by their names, which are those of their content.
pub struct Known {
    key: Hash,
    before: usize,
    pub names: BTreeSet<String>,
}

impl Known {
    /// What judges of these versions took.
    pub fn load(cache: Option<&Cache>, target: Target, versions: &str) -> Self {
        let key = hash(&[KIND, target.name(), versions]);
        let text = cache.and_then(|cache| cache.get(KIND, key)).unwrap_or_default();
        let text = String::from_utf8_lossy(&text);
        let mut names: BTreeSet<String> = text.lines().map(str::to_owned).collect();
        if names.len() > MOST {
            names.clear();
        }
        Self { key, before: names.len(), names }
    }

    /// Remembers them, if there are more than there were.
    pub fn keep(&self, cache: Option<&Cache>) {
        let lines: Vec<&str> = self.names.iter().map(String::as_str).collect();
        if self.names.len() != self.before
            && let Some(cache) = cache
        {
            cache.put(KIND, self.key, Some(lines.join("\n").into_bytes()));
        }
    }
}
