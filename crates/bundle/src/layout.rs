//! The layout of the single file: what the writer and the reader must agree on.
//!
//! ```text
//! header    magic, version, section count, file length,
//!           per section: offset, length, checksum; checksum of all that
//! META      a tree with one root: programs, axes, layouts, entry points, targets, counts
//! KEYS      per key set: records (offset, length) sorted by text, hash slots, text;
//!           per entry point: one unit number for each key of its set, and where some key chooses
//!           constants, the number of a value, or NONE, for each key
//! UNITS     per unit: reflection, first artifact, artifact count; per artifact: target, native, blob
//! VALUES    a tree: reflections, natives, lists of constants
//! BLOBS     per blob: group, offset, length, words of its list, checksum; per piece: group, offset,
//!           length, values; per group: offset, lengths, checksum
//! DATA      groups, zstd, without gaps
//! ```
//! [`super::tree`] says what a tree is. Integers are little-endian, of 32 bits unless said otherwise;
//! nothing is aligned.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::contents::Hash;
use super::store::Layouts;
use super::{Axis, Error, Language, ShardOrigin};

pub const MAGIC: &[u8; 8] = b"LAMPLGHT";

/// Sections in the order of the file.
pub const SECTIONS: [&str; 6] = ["meta", "keys", "units", "values", "blobs", "data"];
pub const META: usize = 0;
pub const KEYS: usize = 1;
pub const UNITS: usize = 2;
pub const VALUES: usize = 3;
pub const BLOBS: usize = 4;
pub const DATA: usize = 5;

/// Magic, version, count, file length; then offset, length and checksum for each section.
pub const HEADER_BYTES: usize = 24 + SECTIONS.len() * 32 + 16;
pub const UNIT_BYTES: usize = 12;
pub const ARTIFACT_BYTES: usize = 12;
pub const RECORD_BYTES: usize = 8;
pub const SLOT_BYTES: usize = 16;
pub const BLOB_BYTES: usize = 32;
pub const PIECE_BYTES: usize = 16;
pub const GROUP_BYTES: usize = 32;

/// The most bytes of a group before compression. It bounds what a damaged length can allocate.
pub const MOST_GROUP_BYTES: usize = lamplight_files::limits::GROUP_BYTES;

/// The most slots that a lookup reads. Unless keys are chosen for their hashes, this many
/// collisions do not occur: in the worst of a million tables a few dozen keys share a slot.
pub const PROBES: usize = 4096;

/// The META section.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Meta {
    pub targets: Vec<TargetMeta>,
    pub programs: BTreeMap<String, ProgramMeta>,
    pub units: u32,
    pub artifacts: u32,
    pub values: u32,
    pub blobs: u32,
    pub pieces: u32,
    pub groups: u32,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shard: Option<ShardOrigin>,
}

#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct TargetMeta {
    pub name: String,
    pub extension: String,
}

#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct ProgramMeta {
    pub axes: Vec<Axis>,
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub layouts: Layouts,
    pub entries: Vec<EntryMeta>,
}

#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct EntryMeta {
    pub language: Language,
    pub name: String,
    pub keys: KeySet,
    /// Where its unit numbers start in KEYS.
    pub units: u32,
    /// Where the numbers of its keys' constants start in KEYS, if some key chooses constants.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub constants: Option<u32>,
}

/// In the place of the number of a value: there is none.
pub const NONE: u32 = u32::MAX;

/// A set of keys, often shared by the entry points of a program.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub struct KeySet {
    pub count: u32,
    /// Where the records start in KEYS.
    pub records: u32,
    /// Where the hash slots start in KEYS, and how many there are, which is a power of two. An
    /// empty slot is zero. In any other slot, the upper 96 bits are those of a key's [`hash_key`],
    /// and the lower 32 bits are the index of its record, plus one. A lookup compares only the 96
    /// bits, since reading the key's text would cost another cache miss. Two keys have the same 96
    /// bits with a probability of 2^-96.
    pub slots: u32,
    pub slot_count: u32,
}

/// A 128-bit hash of a key. Two chains of multiplications run over the key's 64-bit words. Each
/// product of 128 bits is folded to 64 by combining its halves with XOR, so that all its bits
/// count.
pub fn hash_key(key: &[u8]) -> u128 {
    // Odd numbers from the fractions of the square roots of 2, 3, 5 and 7.
    const ROOTS: [u64; 4] = [
        0x6a09_e667_f3bc_c909,
        0xbb67_ae85_84ca_a73b,
        0x3c6e_f372_fe94_f82b,
        0xa54f_f53a_5f1d_36f1,
    ];
    let fold = |a: u64, b: u64| {
        let product = u128::from(a) * u128::from(b);
        product as u64 ^ (product >> 64) as u64
    };
    let length = key.len() as u64;
    let (mut low, mut high) = (length ^ ROOTS[2], length.rotate_left(32) ^ ROOTS[3]);
    let mut mix = |word: [u8; 8]| {
        let word = u64::from_le_bytes(word);
        (low, high) = (fold(low ^ word, ROOTS[0]), fold(high.rotate_left(29) ^ word, ROOTS[1]));
    };
    let (words, rest) = key.as_chunks::<8>();
    words.iter().for_each(|word| mix(*word));
    let mut last = [0; 8];
    last[..rest.len()].copy_from_slice(rest);
    mix(last);
    let (low, high) =
        (fold(low ^ ROOTS[3], ROOTS[1] ^ high), fold(high ^ ROOTS[2], ROOTS[0] ^ low));
    u128::from(high) << 64 | u128::from(low)
}

/// `length` bytes from `at`.
pub fn slice_at<'a>(
    bytes: &'a [u8],
    at: usize,
    length: usize,
    part: &str,
) -> Result<&'a [u8], Error> {
    at.checked_add(length)
        .and_then(|end| bytes.get(at..end))
        .ok_or_else(|| Error::corrupt(part, "a position is out of range"))
}

pub fn u32_at(bytes: &[u8], at: usize, part: &str) -> Result<u32, Error> {
    array_at(bytes, at, part).map(u32::from_le_bytes)
}

pub fn u64_at(bytes: &[u8], at: usize, part: &str) -> Result<u64, Error> {
    array_at(bytes, at, part).map(u64::from_le_bytes)
}

pub fn hash_at(bytes: &[u8], at: usize, part: &str) -> Result<Hash, Error> {
    array_at(bytes, at, part)
}

fn array_at<const N: usize>(bytes: &[u8], at: usize, part: &str) -> Result<[u8; N], Error> {
    let found = bytes.get(at..).and_then(|rest| rest.first_chunk::<N>());
    found.copied().ok_or_else(|| Error::corrupt(part, "a position is out of range"))
}
