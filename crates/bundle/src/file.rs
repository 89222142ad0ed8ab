//! Reads the single file: only its header and META on opening, each table on first use, and
//! compressed groups where a shader is asked for.

mod bytes;
mod outputs;
mod verify;

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::io::ErrorKind;
use std::path::Path;
use std::sync::{Arc, Mutex, OnceLock};

use serde::de::DeserializeOwned;

use bytes::BundleBytes;

use super::contents::{Hash, checksum, refuse_control_characters, to_hex};
use super::layout::*;
use super::pack::pack_outputs;
use super::store::{Store, StoredArtifact, StoredProgram, StoredPrograms, StoredUnit};
use super::tree::Tree;
use super::{Axis, Error, Reflection, ShardOrigin, VERSION};
use crate::packing;
use lamplight_files::limits::{BUNDLE_FACTOR, MANIFEST_BYTES};

/// How many decompressed groups are kept, and how many bytes: about what the shaders of one level
/// of a game need.
const KEPT_GROUPS: usize = 64;
const KEPT_BYTES: usize = 32 << 20;

/// The most bytes of a section that is read as a whole.
const MOST_TABLE_BYTES: usize = MANIFEST_BYTES as usize;

/// An open single-file bundle.
pub struct Packed {
    bytes: BundleBytes,
    sections: [(usize, usize, Hash); SECTIONS.len()],
    /// Each section but DATA, read and compared with its checksum on first use. `None` where the
    /// bytes are in memory anyway.
    tables: [OnceLock<Result<Option<Vec<u8>>, Error>>; SECTIONS.len()],
    meta: Meta,
    programs: StoredPrograms,
    entries: Vec<EntryMeta>,
    groups: Mutex<Vec<(u32, Arc<[u8]>)>>,
}

/// Opens the file. To change it while it is open, replace it by renaming, as [`super::write_file`]
/// does: then this reader keeps the old one. If it is changed in place, errors say so.
pub fn open(path: &Path) -> Result<Packed, Error> {
    parse_file(BundleBytes::open(path)?)
}

/// As [`open`], for bytes in memory.
pub fn from_bytes(bytes: Vec<u8>) -> Result<Packed, Error> {
    parse_file(BundleBytes::Owned(bytes))
}

fn parse_file(bytes: BundleBytes) -> Result<Packed, Error> {
    let sections = read_header(&bytes)?;
    let (offset, length, expected) = sections[META];
    let text = bytes.read(offset, length, "meta")?;
    if checksum(&text) != expected {
        return Err(Error::corrupt("meta", "the checksum does not match"));
    }
    let meta: Meta = Tree::new(&text, "meta")?.get(0)?;
    drop(text);
    meta.targets.iter().try_for_each(|target| {
        refuse_control_characters("meta", [&target.name, &target.extension])
    })?;
    let mut programs = StoredPrograms::new();
    let mut entries = Vec::new();
    for (name, program) in &meta.programs {
        refuse_control_characters(
            "meta",
            std::iter::once(name).chain(program.entries.iter().map(|entry| &entry.name)),
        )?;
        refuse_control_characters("meta", program.axes.iter().flat_map(Axis::names))?;
        let mut numbers = BTreeMap::new();
        for entry in &program.entries {
            numbers.insert((entry.language, entry.name.clone()), entries.len());
            entries.push(entry.clone());
        }
        let (axes, layouts) = (program.axes.clone(), program.layouts.clone());
        programs.insert(name.clone(), StoredProgram { axes, layouts, entries: numbers });
    }
    Ok(Packed {
        bytes,
        sections,
        tables: Default::default(),
        meta,
        programs,
        entries,
        groups: Mutex::default(),
    })
}

/// The offset, length and checksum of each section, from a header whose own checksum is right.
fn read_header(file: &BundleBytes) -> Result<[(usize, usize, Hash); SECTIONS.len()], Error> {
    let part = "header";
    let bytes: &[u8] = &file.read(0, HEADER_BYTES.min(file.len()), part)?;
    if slice_at(bytes, 0, 8, part)? != MAGIC {
        return Err(Error::corrupt(part, "this is not a Lamplight bundle"));
    }
    let version = u32_at(bytes, 8, part)?;
    if version != VERSION {
        return Err(Error::Version { found: version, known: VERSION });
    }
    if hash_at(bytes, HEADER_BYTES - 16, part)?
        != checksum(slice_at(bytes, 0, HEADER_BYTES - 16, part)?)
    {
        return Err(Error::corrupt(part, "the checksum does not match"));
    }
    if u32_at(bytes, 12, part)? as usize != SECTIONS.len()
        || u64_at(bytes, 16, part)? != file.len() as u64
    {
        return Err(Error::corrupt(
            part,
            format!("the file has {} bytes, not those it was written with", file.len()),
        ));
    }
    let mut sections = [(0, 0, [0; 16]); SECTIONS.len()];
    let mut next = HEADER_BYTES;
    for (index, section) in sections.iter_mut().enumerate() {
        let at = 24 + index * 32;
        let (offset, length) =
            (u64_at(bytes, at, part)? as usize, u64_at(bytes, at + 8, part)? as usize);
        if offset.checked_add(length).is_none_or(|end| end > file.len()) {
            return Err(Error::corrupt(SECTIONS[index], "a position is out of range"));
        }
        if offset != next {
            return Err(Error::corrupt(
                SECTIONS[index],
                "the section is not where the one before ends",
            ));
        }
        next = offset + length;
        *section = (offset, length, hash_at(bytes, at + 16, part)?);
    }
    if next == file.len() {
        Ok(sections)
    } else {
        Err(Error::corrupt("data", "bytes follow the last section"))
    }
}

impl Packed {
    /// The bytes of a section other than DATA, whose checksum is verified once.
    fn section(&self, index: usize) -> Result<&[u8], Error> {
        let (offset, length, expected) = self.sections[index];
        let read = || {
            if length > MOST_TABLE_BYTES {
                return Err(Error::corrupt(SECTIONS[index], "the section is too large"));
            }
            let section = self.bytes.read(offset, length, SECTIONS[index])?;
            if checksum(&section) != expected {
                return Err(Error::corrupt(SECTIONS[index], "the checksum does not match"));
            }
            Ok(match section {
                Cow::Owned(section) => Some(section),
                Cow::Borrowed(_) => None,
            })
        };
        match (self.tables[index].get_or_init(read), &self.bytes) {
            (Err(error), _) => Err(error.clone()),
            (Ok(Some(section)), _) => Ok(section),
            (Ok(None), BundleBytes::Owned(all)) => slice_at(all, offset, length, SECTIONS[index]),
            (Ok(None), BundleBytes::Stored { .. }) => Ok(&[]),
        }
    }

    /// A part of DATA. Groups have checksums of their own.
    fn data(&self, at: usize, length: usize, part: &str) -> Result<Cow<'_, [u8]>, Error> {
        let (offset, all, _) = self.sections[DATA];
        match at.checked_add(length) {
            Some(end) if end <= all => self.bytes.read(offset + at, length, part),
            _ => Err(Error::corrupt(part, "a position is out of range")),
        }
    }

    fn entry(&self, entry: usize) -> Result<&EntryMeta, Error> {
        self.entries
            .get(entry)
            .ok_or_else(|| Error::corrupt("meta", "an entry point is out of range"))
    }

    fn key<'a>(&self, keys: &'a [u8], set: &KeySet, index: usize) -> Result<&'a [u8], Error> {
        let record = set.records as usize + index * RECORD_BYTES;
        slice_at(
            keys,
            u32_at(keys, record, "keys")? as usize,
            u32_at(keys, record + 4, "keys")? as usize,
            "keys",
        )
    }

    fn unit_of(&self, keys: &[u8], entry: &EntryMeta, index: usize) -> Result<u32, Error> {
        if index >= entry.keys.count as usize {
            return Err(Error::corrupt("keys", "an index is out of range"));
        }
        u32_at(keys, entry.units as usize + index * 4, "keys")
    }

    /// The description of the bundle, and the sections whose bytes do not depend on how outputs are
    /// stored.
    pub(super) fn tables(&self) -> Result<(&Meta, [&[u8]; 3]), Error> {
        let sections = [self.section(KEYS)?, self.section(UNITS)?, self.section(VALUES)?];
        Ok((&self.meta, sections))
    }

    /// For each blob, the index of the first target that has it.
    pub(super) fn targets_of_blobs(&self) -> Result<Vec<u32>, Error> {
        let mut targets = vec![u32::MAX; self.meta.blobs as usize];
        for artifact in 0..self.meta.artifacts {
            let (target, _, blob) = self.artifact_record(artifact)?;
            let found = targets.get_mut(blob as usize);
            let found = found.ok_or_else(|| Error::corrupt("units", "a blob is out of range"))?;
            *found = target.min(*found);
        }
        Ok(targets)
    }

    /// The extension of a target's files.
    pub(super) fn extension(&self, target: u32) -> Result<&str, Error> {
        self.target(target).map(|target| target.extension.as_str())
    }

    fn target(&self, index: u32) -> Result<&TargetMeta, Error> {
        let target = self.meta.targets.get(index as usize);
        target.ok_or_else(|| Error::corrupt("units", "a target is out of range"))
    }

    /// A value of the section VALUES.
    fn value<T: DeserializeOwned>(&self, index: u32) -> Result<T, Error> {
        if index >= self.meta.values {
            return Err(Error::corrupt("values", "a number is out of range"));
        }
        Tree::new(self.section(VALUES)?, "values")?.get(index)
    }

    /// Of a unit: the reflection, the first artifact and the number of artifacts.
    fn unit_record(&self, unit: u32) -> Result<(u32, u32, u32), Error> {
        let units = self.section(UNITS)?;
        let at = unit as usize * UNIT_BYTES;
        let record = (
            u32_at(units, at, "units")?,
            u32_at(units, at + 4, "units")?,
            u32_at(units, at + 8, "units")?,
        );
        let in_range = unit < self.meta.units
            && record.1.checked_add(record.2).is_some_and(|end| end <= self.meta.artifacts);
        if in_range { Ok(record) } else { Err(Error::corrupt("units", "a number is out of range")) }
    }

    /// Of an artifact: the target, the number of its native text, and the blob.
    fn artifact_record(&self, artifact: u32) -> Result<(u32, u32, u32), Error> {
        let units = self.section(UNITS)?;
        let at = self.meta.units as usize * UNIT_BYTES + artifact as usize * ARTIFACT_BYTES;
        let word = |index: usize| u32_at(units, at + 4 * index, "units");
        Ok((word(0)?, word(1)?, word(2)?))
    }

    fn artifact_of(
        &self,
        target: &TargetMeta,
        native: u32,
        blob: u32,
    ) -> Result<StoredArtifact, Error> {
        let (extension, native) = (target.extension.clone(), Arc::new(self.value(native)?));
        Ok(StoredArtifact { extension, native, blob })
    }

    /// A decompressed group: one that was kept, or else one that is decompressed now.
    fn group(&self, group: u32) -> Result<Arc<[u8]>, Error> {
        if let Ok(kept) = self.groups.lock()
            && let Some((_, bytes)) = kept.iter().find(|(index, _)| *index == group)
        {
            return Ok(bytes.clone());
        }
        let bytes: Arc<[u8]> = self.decompress(group)?.into();
        if let Ok(mut kept) = self.groups.lock() {
            kept.truncate(KEPT_GROUPS - 1);
            kept.insert(0, (group, bytes.clone()));
            let mut sum = 0;
            kept.retain(|(_, bytes)| {
                sum += bytes.len();
                sum <= KEPT_BYTES
            });
        }
        Ok(bytes)
    }

    fn decompress(&self, group: u32) -> Result<Vec<u8>, Error> {
        let part = format!("group {group}");
        let (offset, packed, raw, expected) = self.group_record(group)?;
        let packed = self.data(offset, packed, &part)?;
        if checksum(&packed) != expected {
            return Err(Error::corrupt(part, "the checksum does not match"));
        }
        let bytes = packing::decompress(&packed, raw).map_err(|error| match error.kind() {
            ErrorKind::Unsupported => error.into(),
            _ => Error::corrupt(part.as_str(), error.to_string()),
        })?;
        if bytes.len() == raw {
            Ok(bytes)
        } else {
            Err(Error::corrupt(part, "the length does not match"))
        }
    }

    /// Of a group: offset in DATA, length there, length decompressed, checksum.
    fn group_record(&self, group: u32) -> Result<(usize, usize, usize, Hash), Error> {
        let table = self.section(BLOBS)?;
        let before =
            self.meta.blobs as usize * BLOB_BYTES + self.meta.pieces as usize * PIECE_BYTES;
        let at = before + group as usize * GROUP_BYTES;
        let raw = u32_at(table, at + 12, "blobs")? as usize;
        let packed = u32_at(table, at + 8, "blobs")? as usize;
        // Compressing makes nothing twice as large, but for some bytes around it.
        let is_large = raw > MOST_GROUP_BYTES || packed > 2 * raw + 1024;
        if group >= self.meta.groups || is_large {
            return Err(Error::corrupt("blobs", "a group is out of range"));
        }
        Ok((u64_at(table, at, "blobs")? as usize, packed, raw, hash_at(table, at + 16, "blobs")?))
    }
}

impl Store for Packed {
    fn programs(&self) -> &StoredPrograms {
        &self.programs
    }

    fn shard(&self) -> Option<&ShardOrigin> {
        self.meta.shard.as_ref()
    }

    fn find(&self, entry: usize, key: &str) -> Result<Option<u32>, Error> {
        let entry = self.entry(entry)?;
        let set = &entry.keys;
        let keys = self.section(KEYS)?;
        if !set.slot_count.is_power_of_two() {
            return Err(Error::corrupt("meta", "a number of slots is not a power of two"));
        }
        let slots =
            slice_at(keys, set.slots as usize, set.slot_count as usize * SLOT_BYTES, "keys")?
                .as_chunks::<SLOT_BYTES>()
                .0;
        let hash = hash_key(key.as_bytes());
        let mask = slots.len() - 1;
        for step in 0..slots.len().min(PROBES) {
            let slot = u128::from_le_bytes(slots[(hash as usize).wrapping_add(step) & mask]);
            if slot as u32 == 0 {
                return Ok(None);
            }
            if slot >> 32 == hash >> 32 {
                return self.unit_of(keys, entry, slot as u32 as usize - 1).map(Some);
            }
        }
        if slots.len() > PROBES {
            return Err(Error::corrupt("keys", "the slots are too full"));
        }
        Ok(None)
    }

    fn each_key(&self, entry: usize, visit: &mut dyn FnMut(&str, u32)) -> Result<(), Error> {
        let entry = self.entry(entry)?;
        let keys = self.section(KEYS)?;
        for index in 0..entry.keys.count as usize {
            let key = std::str::from_utf8(self.key(keys, &entry.keys, index)?)
                .map_err(|_| Error::corrupt("keys", "a key is not UTF-8"))?;
            visit(key, self.unit_of(keys, entry, index)?);
        }
        Ok(())
    }

    fn unit(&self, unit: u32) -> Result<StoredUnit, Error> {
        let (reflection, first, count) = self.unit_record(unit)?;
        let mut targets = BTreeMap::new();
        for artifact in first..first + count {
            let (target, native, blob) = self.artifact_record(artifact)?;
            let target = self.target(target)?;
            targets.insert(target.name.clone(), self.artifact_of(target, native, blob)?);
        }
        Ok(StoredUnit { reflection: Arc::new(self.value(reflection)?), targets })
    }

    fn artifact(
        &self,
        unit: u32,
        target: &str,
    ) -> Result<(Arc<Reflection>, StoredArtifact), Error> {
        let (reflection, first, count) = self.unit_record(unit)?;
        let mut known = Vec::new();
        for artifact in first..first + count {
            let (found, native, blob) = self.artifact_record(artifact)?;
            let found = self.target(found)?;
            if found.name == target {
                let artifact = self.artifact_of(found, native, blob)?;
                return Ok((Arc::new(self.value(reflection)?), artifact));
            }
            known.push(found.name.clone());
        }
        Err(Error::NotFound { what: "target", name: target.to_owned(), known })
    }

    fn blob(&self, blob: u32) -> Result<Vec<u8>, Error> {
        self.output(&self.blob_record(blob)?)
    }

    fn digest(&self, blob: u32) -> Result<String, Error> {
        self.blob_record(blob).map(|record| to_hex(&record.sum))
    }

    fn measure(&self) -> Result<(), Error> {
        self.within_budget()?;
        self.outputs_within(BUNDLE_FACTOR)
    }

    fn verify(&self) -> Result<(), Error> {
        self.verify_all()
    }

    fn pack(&self) -> Result<Vec<u8>, Error> {
        pack_outputs(self, &|blob| self.blob(blob))
    }
}
