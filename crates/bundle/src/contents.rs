//! A bundle in memory: what the writers take, and what `Bundle::contents` returns.

use std::collections::BTreeMap;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::{Digest, Digester, Error, Language, Native, Reflection, ShardOrigin, shard};

/// The first 128 bits of BLAKE3, which name units and blobs by their content.
pub type Hash = [u8; 16];

/// Everything of a bundle, by program.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Contents {
    /// Programs by name.
    pub programs: BTreeMap<String, ProgramContents>,
    /// What the contents were made of, if they are a part of a bundle.
    pub shard: Option<ShardOrigin>,
}

/// One program: its axes, and its shaders by language and entry point.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct ProgramContents {
    /// In the order of the manifest.
    pub axes: Vec<Axis>,
    /// Entry points by name, for each language that the program is written in.
    pub languages: BTreeMap<Language, BTreeMap<String, EntryContents>>,
}

/// One axis of a program, with its values in the manifest's order.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Axis {
    /// As keys name it.
    pub name: String,
    /// Its values, as keys write them.
    pub values: Vec<String>,
    /// The default, which a key need not name.
    pub default: String,
    /// `static`, `spec` or `dynamic`.
    pub mode: String,
}

impl Axis {
    /// Every string in it: its name, its default, its mode and its values.
    pub(super) fn names(&self) -> impl Iterator<Item = &String> {
        [&self.name, &self.default, &self.mode].into_iter().chain(&self.values)
    }
}

/// One entry point. Many keys share a unit.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct EntryContents {
    /// The units, by [`Unit::hash`].
    pub units: BTreeMap<Hash, Unit>,
    /// The unit of each canonical key.
    pub keys: BTreeMap<String, Hash>,
}

/// One shader in all its targets.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Unit {
    /// What is bound, and what enters and leaves the stage.
    pub reflection: Arc<Reflection>,
    /// By the name of the target, so that a bundle may have targets that this build does not know.
    pub targets: BTreeMap<String, Artifact>,
}

/// One shader in one target.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Artifact {
    /// The output: text, or the words of SPIR-V.
    pub bytes: Arc<[u8]>,
    /// Of the blob's file in the directory form.
    pub extension: String,
    /// Names and numbers that this target has for what the reflection lists.
    pub native: Arc<Native>,
}

impl Unit {
    /// The hash of the unit, with the hashes of its reflection and of each target's blob and names.
    /// Each blob is read only once.
    ///
    /// # Errors
    /// [`Error::Io`] for a blob of 4 GiB or more.
    pub fn digest(&self) -> Result<Digest, Error> {
        Digester::default().digest(self)
    }

    /// Equal for units with equal content, on any machine.
    pub fn hash(&self) -> Result<Hash, Error> {
        Ok(self.digest()?.unit)
    }
}

impl EntryContents {
    /// Adds a unit and returns its hash, by which keys refer to it.
    pub fn add(&mut self, unit: Unit) -> Result<Hash, Error> {
        let hash = unit.hash()?;
        self.units.entry(hash).or_insert(unit);
        Ok(hash)
    }
}

impl Contents {
    /// The entry points of all programs and languages, in order.
    pub fn entries(&self) -> impl Iterator<Item = &EntryContents> {
        let languages = self.programs.values().flat_map(|program| program.languages.values());
        languages.flat_map(BTreeMap::values)
    }

    /// As [`Self::entries`], but mutable.
    pub fn entries_mut(&mut self) -> impl Iterator<Item = &mut EntryContents> {
        let programs = self.programs.values_mut();
        programs.flat_map(|program| program.languages.values_mut()).flat_map(BTreeMap::values_mut)
    }

    /// Adds the programs, units and keys of another bundle, as from another shard.
    ///
    /// # Errors
    /// [`Error::Conflict`] if both have different shaders for a key, or different axes for a
    /// program, or if they are shards that were not made of the same.
    pub fn merge(&mut self, other: Self) -> Result<(), Error> {
        let Self { programs, shard: origin } = other;
        self.shard = shard::joined(self.shard.take(), origin).map_err(|mismatch| {
            Error::Conflict(format!("their origin: they {}", mismatch.message()))
        })?;
        for (name, program) in programs {
            let mine = self.programs.entry(name.clone()).or_insert_with(|| ProgramContents {
                axes: program.axes.clone(),
                ..Default::default()
            });
            if mine.axes != program.axes {
                return Err(Error::Conflict(format!("the axes of program `{name}`")));
            }
            for (language, entries) in program.languages {
                for (entry, contents) in entries {
                    merge_entry(
                        mine.languages.entry(language).or_default().entry(entry).or_default(),
                        contents,
                    )?;
                }
            }
        }
        Ok(())
    }
}

fn merge_entry(mine: &mut EntryContents, other: EntryContents) -> Result<(), Error> {
    mine.units.extend(other.units);
    for (key, unit) in other.keys {
        if *mine.keys.entry(key.clone()).or_insert(unit) != unit {
            return Err(Error::Conflict(format!("permutation `{key}`")));
        }
    }
    Ok(())
}

/// Refuses names with control characters, since printing such a name could change the state of a
/// terminal.
pub(super) fn refuse_control_characters<'a>(
    part: &str,
    names: impl IntoIterator<Item = &'a String>,
) -> Result<(), Error> {
    match names.into_iter().find(|name| name.chars().any(char::is_control)) {
        None => Ok(()),
        Some(name) => Err(Error::corrupt(
            part,
            format!("{name:?} has control characters, so it is not a name"),
        )),
    }
}

pub(super) fn to_json<T: Serialize>(value: &T) -> Result<Vec<u8>, Error> {
    serde_json::to_vec(value).map_err(|error| Error::Io(error.to_string()))
}

/// The first 128 bits.
pub fn shortened_hash(hash: &blake3::Hash) -> Hash {
    let mut short = [0; 16];
    short.copy_from_slice(&hash.as_bytes()[..16]);
    short
}

/// The checksum used everywhere in a bundle.
pub(super) fn checksum(bytes: &[u8]) -> Hash {
    shortened_hash(&blake3::hash(bytes))
}

const DIGITS: [char; 16] =
    ['0', '1', '2', '3', '4', '5', '6', '7', '8', '9', 'a', 'b', 'c', 'd', 'e', 'f'];

/// Lower-case hexadecimal.
pub fn to_hex(bytes: &[u8]) -> String {
    let mut text = String::with_capacity(2 * bytes.len());
    for byte in bytes {
        text.push(DIGITS[usize::from(byte >> 4)]);
        text.push(DIGITS[usize::from(byte & 15)]);
    }
    text
}

/// Reads what [`to_hex`] wrote.
pub(super) fn from_hex(text: &str) -> Option<Hash> {
    let mut hash = [0; 16];
    let (pairs, rest) = text.as_bytes().as_chunks::<2>();
    if pairs.len() != hash.len() || !rest.is_empty() {
        return None;
    }
    for (byte, [high, low]) in hash.iter_mut().zip(pairs) {
        let digit = |letter: &u8| char::from(*letter).to_digit(16);
        *byte = u8::try_from(digit(high)? << 4 | digit(low)?).ok()?;
    }
    Some(hash)
}
