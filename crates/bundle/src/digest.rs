//! The hashes of units, by which a bundle names them.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use serde::Serialize;

use super::contents::{checksum, shortened_hash, to_json};
use super::{Error, Hash, Native, Reflection, Unit};

/// How many reflections, and how many natives, a [`Digester`] remembers before it forgets all of
/// them.
const REMEMBERED: usize = 4096;

/// The hashes of a unit.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Digest {
    /// Equal for units with equal content, on any machine.
    pub unit: Hash,
    /// The checksum of the reflection as JSON.
    pub reflection: Hash,
    /// The hashes of each target, in the order of [`Unit::targets`].
    pub targets: Box<[TargetDigest]>,
}

/// The hashes of one target of a unit.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TargetDigest {
    /// The checksum of the bytes.
    pub blob: Hash,
    /// How many bytes there are.
    pub length: u32,
    /// The checksum of the target's own names and numbers as JSON.
    pub native: Hash,
}

/// Hashes units, and remembers the hashes of what many units share: the reflection of an entry
/// point, and each target's names and numbers for it. A digest does not depend on what is
/// remembered.
#[derive(Debug, Default)]
pub struct Digester {
    reflections: KnownHashes<Reflection>,
    natives: KnownHashes<Native>,
}

impl Digester {
    /// The hash of the unit, with the hashes of its reflection and of each target's blob and names.
    /// Each blob is read only once.
    ///
    /// # Errors
    /// [`Error::Io`] for a blob of 4 GiB or more.
    pub fn digest(&self, unit: &Unit) -> Result<Digest, Error> {
        let mut hasher = blake3::Hasher::new();
        let mut part = |bytes: &[u8]| {
            hasher.update(&(bytes.len() as u64).to_le_bytes());
            hasher.update(bytes);
        };
        let reflection = self.reflections.json(&unit.reflection)?;
        part(&reflection.json);
        let mut targets = Vec::with_capacity(unit.targets.len());
        for (target, artifact) in &unit.targets {
            let length = u32::try_from(artifact.bytes.len())
                .map_err(|_| Error::Io(format!("the shader for `{target}` is too large")))?;
            let (blob, native) = (checksum(&artifact.bytes), self.natives.json(&artifact.native)?);
            part(target.as_bytes());
            part(artifact.extension.as_bytes());
            part(&native.json);
            part(&blob);
            targets.push(TargetDigest { blob, length, native: native.hash });
        }
        let unit = shortened_hash(&hasher.finalize());
        Ok(Digest { unit, reflection: reflection.hash, targets: targets.into() })
    }
}

/// The JSON of a value, with its checksum.
#[derive(Debug)]
struct Hashed {
    json: Vec<u8>,
    hash: Hash,
}

/// The hashes of values, by the address of the value. The stored `Arc` keeps the address from being
/// reused.
#[derive(Debug)]
struct KnownHashes<T>(Mutex<ByAddress<T>>);

type ByAddress<T> = BTreeMap<usize, (Arc<T>, Arc<Hashed>)>;

impl<T> Default for KnownHashes<T> {
    fn default() -> Self {
        Self(Mutex::default())
    }
}

impl<T: Serialize> KnownHashes<T> {
    fn json(&self, value: &Arc<T>) -> Result<Arc<Hashed>, Error> {
        let address = Arc::as_ptr(value) as usize;
        let known = || self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, found)) = known().get(&address) {
            return Ok(found.clone());
        }
        let json = to_json(&**value)?;
        let hashed = Arc::new(Hashed { hash: checksum(&json), json });
        let mut known = known();
        if known.len() >= REMEMBERED {
            known.clear();
        }
        known.insert(address, (value.clone(), hashed.clone()));
        Ok(hashed)
    }
}
