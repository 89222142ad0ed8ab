//! What both forms of a bundle offer the loader.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::{Axis, Error, Language, LayoutBinding, Native, Reflection, ShardOrigin};

/// The part of a bundle that is in memory once it is open, which is small.
pub type StoredPrograms = BTreeMap<String, StoredProgram>;

/// What the permutations of a program bind together, by language.
pub type Layouts = BTreeMap<Language, Vec<LayoutBinding>>;

/// One program of an open bundle.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct StoredProgram {
    pub axes: Vec<Axis>,
    /// What all permutations bind together, by language.
    pub layouts: Layouts,
    /// Numbers of the entry points, by language and name.
    pub entries: BTreeMap<(Language, String), usize>,
}

/// A unit whose bytes were not read yet.
pub struct StoredUnit {
    pub reflection: Arc<Reflection>,
    pub targets: BTreeMap<String, StoredArtifact>,
}

/// One target of a unit.
pub struct StoredArtifact {
    pub extension: String,
    pub native: Arc<Native>,
    /// Number of the blob in its store.
    pub blob: u32,
}

/// An open bundle of one form. Entry points, units and blobs are named by their index, which is
/// checked on each use.
pub trait Store: Send + Sync {
    fn programs(&self) -> &StoredPrograms;

    /// What the bundle was made of, if it is a part of one.
    fn shard(&self) -> Option<&ShardOrigin>;

    /// The unit of a key in canonical form.
    fn find(&self, entry: usize, key: &str) -> Result<Option<u32>, Error>;

    /// Every key, sorted, with its unit.
    fn each_key(&self, entry: usize, visit: &mut dyn FnMut(&str, u32)) -> Result<(), Error>;

    fn unit(&self, unit: u32) -> Result<StoredUnit, Error>;

    /// One target of a unit and its reflection, without reading the other targets.
    fn artifact(
        &self,
        unit: u32,
        target: &str,
    ) -> Result<(Arc<Reflection>, StoredArtifact), Error> {
        let mut unit = self.unit(unit)?;
        match unit.targets.remove(target) {
            Some(artifact) => Ok((unit.reflection, artifact)),
            None => Err(Error::NotFound {
                what: "target",
                name: target.to_owned(),
                known: unit.targets.into_keys().collect(),
            }),
        }
    }

    /// The bytes of a blob, verified.
    fn blob(&self, blob: u32) -> Result<Vec<u8>, Error>;

    /// The hash of a blob's bytes, without reading them.
    fn digest(&self, blob: u32) -> Result<String, Error>;

    /// Refuses a bundle that would take memory or time out of proportion to its size.
    fn measure(&self) -> Result<(), Error>;

    /// Checks every byte.
    fn verify(&self) -> Result<(), Error>;

    /// The single file with the same content.
    fn pack(&self) -> Result<Vec<u8>, Error>;
}
