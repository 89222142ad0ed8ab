//! Remembers that a whole bundle was validated, so that the next run need not look at its outputs.

use lamplight_bundle::{Hash, Target};
use lamplight_generate::Validation;
use lamplight_generate::cache::{Cache, hash_parts};
use rayon::prelude::*;

use crate::known::KIND;
use crate::{Extent, Tint, validator_versions};

/// The record of one bundle, for validators of the versions that are installed now. A validator
/// that is missing has no version, so the bundle is validated again once it is there.
pub struct BundleRecord {
    keys: Vec<Hash>,
}

impl BundleRecord {
    /// Parameters: a name for the content of the bundle; the names of its targets.
    pub fn new(bundle: &str, targets: &[&str], extent: Extent, tint: &Tint) -> Self {
        let known = targets.iter().filter_map(|name| Target::find(name));
        let targets: Vec<Target> = known.collect();
        let versions: Vec<String> =
            targets.par_iter().map(|target| validator_versions(*target, tint)).collect();
        let versions: String = versions.join("\n");
        let key = |extent: Extent| hash_parts(&[KIND, "bundle", bundle, extent.name(), &versions]);
        // All outputs have all lines.
        let extents: &[Extent] = match extent {
            Extent::Lines => &[Extent::Lines, Extent::All],
            Extent::All => &[Extent::All],
            Extent::Nothing => &[],
        };
        Self { keys: extents.iter().map(|extent| key(*extent)).collect() }
    }

    /// The recorded verdicts on it.
    pub fn find(&self, cache: &Cache) -> Option<Validation> {
        let found = self.keys.iter().find_map(|key| cache.get(KIND, *key))?;
        serde_json::from_slice::<Validation>(&found).ok().map(Validation::earlier)
    }

    /// Stores the verdicts for [`Self::find`].
    pub fn keep(&self, cache: &Cache, validation: &Validation) {
        if let Some(key) = self.keys.first() {
            cache.put(KIND, *key, serde_json::to_vec(validation).ok());
        }
    }
}
