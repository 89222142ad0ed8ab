//! Where compiled units go.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

use lamplight_bundle::{Contents, Digest, Digester, DirectoryWriter, Error, Hash, Unit};

/// Takes units as they are made, from many threads.
pub trait Sink: Sync {
    /// Takes a unit, perhaps not for the first time; keys refer to it by the digest's hash.
    fn add(&self, unit: Unit) -> Result<Digest, Error>;
}

/// Writes each unit at once and keeps none.
impl Sink for DirectoryWriter {
    fn add(&self, unit: Unit) -> Result<Digest, Error> {
        Self::add(self, &unit)
    }
}

/// Keeps every unit in memory.
#[derive(Debug, Default)]
pub struct MemorySink {
    digester: Digester,
    units: Mutex<BTreeMap<Hash, Unit>>,
}

impl Sink for MemorySink {
    fn add(&self, unit: Unit) -> Result<Digest, Error> {
        let digest = self.digester.digest(&unit)?;
        self.units
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .entry(digest.unit)
            .or_insert(unit);
        Ok(digest)
    }
}

impl MemorySink {
    /// Gives every entry point the units that its keys refer to.
    pub fn fill(self, contents: &mut Contents) {
        let units = self.units.into_inner().unwrap_or_else(PoisonError::into_inner);
        for entry in contents.entries_mut() {
            entry.units = entry
                .keys
                .values()
                .filter_map(|hash| Some((*hash, units.get(hash)?.clone())))
                .collect();
        }
    }
}

/// Looks at each unit and keeps none: to count, or to measure.
#[derive(Debug, Default)]
pub struct Discard(Digester);

impl Sink for Discard {
    fn add(&self, unit: Unit) -> Result<Digest, Error> {
        self.0.digest(&unit)
    }
}
