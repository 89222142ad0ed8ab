//! Writes the single file; [`super::layout`] says how it is laid out.

use std::collections::BTreeMap;
use std::io::Read;
use std::path::Path;
use std::sync::Arc;

use serde::Serialize;
use serde_json::Value;

use super::contents::{checksum, to_json};
use super::file::Packed;
use super::layout::{
    EntryMeta, HEADER_BYTES, KeySet, MAGIC, MOST_GROUP_BYTES, Meta, NONE, PROBES, ProgramMeta,
    RECORD_BYTES, SLOT_BYTES, TargetMeta, hash_key,
};
use super::manifest::{FileStub, Manifest};
use super::pieces::{List, Piece, PieceTable};
use super::program_layout::{EntryKeys, program_layout};
use super::tree::TreeBuilder;
use super::{Bundle, Constant, Contents, EntryContents, Error, Hash, Unit, VERSION};
use crate::packing;
use lamplight_files::input;
use lamplight_files::output::{self, Foreign, Replace};

/// A group is closed when it has this many bytes. That is large enough for neighbours to share what
/// they have in common, and small enough to be decompressed within a millisecond.
const GROUP_BYTES: usize = 256 << 10;

/// Writes the single-file form. The same contents always give the same bytes.
///
/// # Errors
/// [`Error::Io`] where a table is larger than 4 GiB or a blob larger than 16 MiB.
pub fn pack(contents: &Contents) -> Result<Vec<u8>, Error> {
    pack_blobs(contents, BlobPlace::Data)
}

fn pack_blobs(contents: &Contents, place: BlobPlace) -> Result<Vec<u8>, Error> {
    let Contents { programs, shard } = contents;
    let mut packer = Packer { place, ..Packer::default() };
    packer.meta.shard.clone_from(shard);
    packer.collect_blobs(contents)?;
    for (name, program) in programs {
        let (mut sets, mut bound) = (BTreeMap::new(), BTreeMap::new());
        let mut entries = Vec::new();
        for (language, entry, contents) in
            program.languages.iter().flat_map(|(language, entries)| {
                entries.iter().map(move |(name, entry)| (*language, name, entry))
            })
        {
            let keys = packer.key_set(&mut sets, contents)?;
            let units = packer.unit_numbers(contents)?;
            let grouped = EntryKeys::new(contents.keys.iter().filter_map(|(key, hash)| {
                Some((key.as_str(), &*contents.units.get(hash)?.reflection))
            }));
            let constants = packer.constants(&grouped.constants(&program.axes)?, contents)?;
            bound.entry(language).or_insert_with(Vec::new).push(grouped);
            entries.push(EntryMeta { language, name: entry.clone(), keys, units, constants });
        }
        let layouts = bound
            .into_iter()
            .map(|(language, entries)| (language, program_layout(&program.axes, &entries)))
            .collect();
        let program = ProgramMeta { axes: program.axes.clone(), layouts, entries };
        packer.meta.programs.insert(name.clone(), program);
    }
    packer.finish()
}

/// As [`pack`], into a file. It is replaced as a whole, if it is a bundle or empty or does not
/// exist.
pub fn write_file(contents: &Contents, path: impl AsRef<Path>) -> Result<(), Error> {
    replace_file(contents, path, Replace::Ours)
}

/// As [`write_file`], but replaces what the caller allows.
pub fn replace_file(
    contents: &Contents,
    path: impl AsRef<Path>,
    replace: Replace,
) -> Result<(), Error> {
    replace_bytes(path, replace, || pack(contents))
}

/// As [`replace_file`], for the single-file form that [`super::Bundle::pack`] returns.
pub fn replace_packed(
    bundle: &Bundle,
    path: impl AsRef<Path>,
    replace: Replace,
) -> Result<(), Error> {
    replace_bytes(path, replace, || bundle.pack())
}

fn replace_bytes(
    path: impl AsRef<Path>,
    replace: Replace,
    pack: impl FnOnce() -> Result<Vec<u8>, Error>,
) -> Result<(), Error> {
    let path = path.as_ref();
    if replace == Replace::Ours
        && let Some(found) = newer_version(path)
    {
        return Err(Error::Foreign(Foreign::file(path, newer_bundle(found))));
    }
    let is_bundle = |head: &[u8]| head.starts_with(MAGIC);
    Ok(output::write_file(path, &pack()?, is_bundle, replace)?)
}

/// The version of the bundle in a file, if it is newer than the one that is written here.
fn newer_version(path: &Path) -> Option<u32> {
    let mut head = [0; MAGIC.len() + 4];
    input::open_file(path).ok()?.read_exact(&mut head).ok()?;
    let version = head.strip_prefix(MAGIC)?.first_chunk()?;
    Some(u32::from_le_bytes(*version)).filter(|version| *version > VERSION)
}

/// What a bundle of a newer format is, as the end of a sentence.
pub(super) fn newer_bundle(version: u32) -> String {
    format!("is a bundle of format version {version}, which is newer than version {VERSION}")
}

/// The index of a directory: the single file without its data. A blob of group [`NONE`] is in the
/// file that its hash names.
pub(super) fn pack_index(manifest: &Manifest) -> Result<Vec<u8>, Error> {
    pack_blobs(&manifest.contents()?, BlobPlace::Files)
}

/// Where blobs are.
#[derive(Default, Clone, Copy, PartialEq, Eq)]
enum BlobPlace {
    /// In the section DATA.
    #[default]
    Data,
    /// In files. The bytes of an artifact are a [`FileStub`].
    Files,
}

/// An output on its way into the file.
struct Blob {
    length: u32,
    sum: Hash,
    body: Body,
}

/// What a group has of a blob.
enum Body {
    /// Nothing: it is in a file.
    File,
    Whole(Arc<[u8]>),
    Pieces(List),
}

#[derive(Default)]
struct Packer {
    place: BlobPlace,
    meta: Meta,
    keys: Vec<u8>,
    units: Vec<u8>,
    unit_numbers: BTreeMap<Hash, u32>,
    artifacts: Vec<u8>,
    values: TreeBuilder,
    value_numbers: BTreeMap<Vec<u8>, u32>,
    outputs: Outputs,
    blob_numbers: BTreeMap<Hash, u32>,
}

impl Packer {
    /// Numbers the blobs so that similar ones are neighbours: by target, then by entry point.
    fn collect_blobs(&mut self, contents: &Contents) -> Result<(), Error> {
        let units = contents.entries().flat_map(|entry| entry.units.values());
        let artifacts = units.flat_map(|unit| &unit.targets);
        let mut targets: Vec<TargetMeta> = artifacts
            .map(|(name, artifact)| TargetMeta {
                name: name.clone(),
                extension: artifact.extension.clone(),
            })
            .collect();
        targets.sort();
        targets.dedup();
        for (index, target) in (0..).zip(&targets) {
            let units = contents.entries().flat_map(in_key_order);
            for artifact in units.filter_map(|unit| unit.targets.get(&target.name)) {
                if artifact.extension == target.extension {
                    self.add_blob(&artifact.bytes, index)?;
                }
            }
        }
        self.meta.targets = targets;
        Ok(())
    }

    fn add_blob(&mut self, bytes: &Arc<[u8]>, target: u32) -> Result<(), Error> {
        let sum = self.blob_hash(bytes);
        let next = to_u32(self.blob_numbers.len())?;
        if *self.blob_numbers.entry(sum).or_insert(next) != next {
            return Ok(());
        }
        match self.place {
            BlobPlace::Files => self.outputs.add_stub(FileStub::read(bytes)),
            BlobPlace::Data => self.outputs.add(bytes, sum, target)?,
        }
        Ok(())
    }

    fn blob_hash(&self, bytes: &[u8]) -> Hash {
        match self.place {
            BlobPlace::Data => checksum(bytes),
            BlobPlace::Files => FileStub::read(bytes).hash,
        }
    }

    /// Writes the keys of an entry point as a set, unless an earlier entry point of the program has
    /// the same keys.
    fn key_set<'a>(
        &mut self,
        sets: &mut BTreeMap<Vec<&'a str>, KeySet>,
        entry: &'a EntryContents,
    ) -> Result<KeySet, Error> {
        let keys: Vec<&str> = entry.keys.keys().map(String::as_str).collect();
        if let Some(set) = sets.get(&keys) {
            return Ok(*set);
        }
        let slot_count = (keys.len() + keys.len() / 4 + 1).next_power_of_two();
        let set = KeySet {
            count: to_u32(keys.len())?,
            records: to_u32(self.keys.len())?,
            slots: to_u32(self.keys.len() + keys.len() * RECORD_BYTES)?,
            slot_count: to_u32(slot_count)?,
        };
        let mut text_at = self.keys.len() + keys.len() * RECORD_BYTES + slot_count * SLOT_BYTES;
        for key in &keys {
            push_words(&mut self.keys, &[to_u32(text_at)?, to_u32(key.len())?]);
            text_at += key.len();
        }
        build_slots(&keys, slot_count)?
            .iter()
            .for_each(|slot| self.keys.extend_from_slice(&slot.to_le_bytes()));
        keys.iter().for_each(|key| self.keys.extend_from_slice(key.as_bytes()));
        sets.insert(keys, set);
        Ok(set)
    }

    /// Writes one unit number for each key, and returns where they start.
    fn unit_numbers(&mut self, entry: &EntryContents) -> Result<u32, Error> {
        let start = to_u32(self.keys.len())?;
        for hash in entry.keys.values() {
            let unit = entry
                .units
                .get(hash)
                .ok_or_else(|| Error::Io("a key refers to no unit".to_owned()))?;
            let unit = self.unit(hash, unit)?;
            push_words(&mut self.keys, &[unit]);
        }
        Ok(start)
    }

    fn unit(&mut self, hash: &Hash, unit: &Unit) -> Result<u32, Error> {
        if let Some(number) = self.unit_numbers.get(hash) {
            return Ok(*number);
        }
        let reflection = self.value(&*unit.reflection)?;
        push_words(
            &mut self.units,
            &[reflection, self.meta.artifacts, to_u32(unit.targets.len())?],
        );
        for (target, artifact) in &unit.targets {
            let position =
                |known: &TargetMeta| known.name == *target && known.extension == artifact.extension;
            let target = to_u32(self.meta.targets.iter().position(position).unwrap_or_default())?;
            let native = self.value(&*artifact.native)?;
            let blob = self
                .blob_numbers
                .get(&self.blob_hash(&artifact.bytes))
                .copied()
                .unwrap_or_default();
            push_words(&mut self.artifacts, &[target, native, blob]);
            self.meta.artifacts += 1;
        }
        self.unit_numbers.insert(*hash, self.meta.units);
        self.meta.units += 1;
        Ok(self.meta.units - 1)
    }

    /// The number of a value in VALUES; equal ones have one number.
    fn value(&mut self, value: &impl Serialize) -> Result<u32, Error> {
        let json = to_json(value)?;
        if let Some(number) = self.value_numbers.get(&json) {
            return Ok(*number);
        }
        let number = self.values.add(&to_value(value)?)?;
        self.value_numbers.insert(json, number);
        Ok(number)
    }

    /// Writes the number of the constants of each key, and returns where they start. Nothing where
    /// no key chooses a constant.
    fn constants(
        &mut self,
        chosen: &BTreeMap<&str, Vec<Constant>>,
        entry: &EntryContents,
    ) -> Result<Option<u32>, Error> {
        if chosen.is_empty() {
            return Ok(None);
        }
        let start = to_u32(self.keys.len())?;
        for key in entry.keys.keys() {
            let number = match chosen.get(key.as_str()) {
                Some(list) => self.value(list)?,
                None => NONE,
            };
            push_words(&mut self.keys, &[number]);
        }
        Ok(Some(start))
    }

    fn finish(mut self) -> Result<Vec<u8>, Error> {
        self.meta.values = to_u32(self.value_numbers.len())?;
        self.units.append(&mut self.artifacts);
        let values = self.values.finish()?;
        finish_file(self.meta, [&self.keys, &self.units, &values], self.outputs)
    }
}

/// The single file with the content of an open bundle, whose blobs `read` returns. Only the sections
/// BLOBS and DATA are made anew.
pub(super) fn pack_outputs(
    index: &Packed,
    read: &dyn Fn(u32) -> Result<Vec<u8>, Error>,
) -> Result<Vec<u8>, Error> {
    let (meta, tables) = index.tables()?;
    let mut outputs = Outputs::default();
    for (blob, target) in (0..).zip(index.targets_of_blobs()?) {
        let bytes = read(blob)?;
        outputs.add(&bytes.into(), index.blob_record(blob)?.sum, target)?;
    }
    finish_file(meta.clone(), tables, outputs)
}

fn finish_file(meta: Meta, tables: [&[u8]; 3], outputs: Outputs) -> Result<Vec<u8>, Error> {
    let Sections { blobs, pieces, groups, table, data } = outputs.finish()?;
    let mut root = TreeBuilder::default();
    root.add(&to_value(&Meta { blobs, pieces, groups, ..meta })?)?;
    let [keys, units, values] = tables;
    join_sections([&root.finish()?, keys, units, values, &table, &data])
}

/// Outputs on their way into the file.
#[derive(Default)]
struct Outputs {
    blobs: Vec<Blob>,
    pieces: PieceTable,
}

/// The sections BLOBS and DATA, and how many there are of what.
struct Sections {
    blobs: u32,
    pieces: u32,
    groups: u32,
    table: Vec<u8>,
    data: Vec<u8>,
}

impl Outputs {
    fn add_stub(&mut self, FileStub { hash, length }: FileStub) {
        self.blobs.push(Blob { length, sum: hash, body: Body::File });
    }

    fn add(&mut self, bytes: &Arc<[u8]>, sum: Hash, target: u32) -> Result<(), Error> {
        if bytes.len() > MOST_GROUP_BYTES {
            return Err(Error::Io(format!(
                "a blob of {} bytes is larger than a bundle takes",
                bytes.len()
            )));
        }
        let list = self.pieces.split(bytes, target).map_err(|_| outgrown())?;
        let body = list.map_or_else(|| Body::Whole(bytes.clone()), Body::Pieces);
        self.blobs.push(Blob { length: to_u32(bytes.len())?, sum, body });
        Ok(())
    }

    fn finish(self) -> Result<Sections, Error> {
        let Self { blobs, pieces } = self;
        let (pieces, renumbering) = pieces.finish();
        let (blob_count, piece_count) = (to_u32(blobs.len())?, to_u32(pieces.len())?);
        let (mut table, mut groups) = (Vec::new(), Groups::default());
        for Blob { length, sum, body } in blobs {
            let ([group, offset], words) = match body {
                Body::File => ([NONE, 0], 0),
                Body::Whole(bytes) => (groups.add(Kind::Whole, &bytes)?, 0),
                Body::Pieces(mut list) => {
                    renumbering.apply(&mut list);
                    let mut bytes = Vec::with_capacity(4 * list.len());
                    push_words(&mut bytes, &list);
                    (groups.add(Kind::Lists, &bytes)?, to_u32(list.len())?)
                }
            };
            push_words(&mut table, &[group, offset, length, words]);
            table.extend_from_slice(&sum);
        }
        for Piece { bytes, length, values } in pieces {
            let [group, offset] = groups.add(Kind::Pieces, &bytes)?;
            push_words(&mut table, &[group, offset, length, values]);
        }
        let (count, mut records, data) = groups.finish()?;
        table.append(&mut records);
        Ok(Sections { blobs: blob_count, pieces: piece_count, groups: count, table, data })
    }
}

/// What a group has. Each has one kind, since what is alike compresses well together.
#[derive(Default, Clone, Copy, PartialEq, Eq)]
enum Kind {
    #[default]
    Whole,
    Lists,
    Pieces,
}

/// Collects the bytes of groups, and compresses each when it is full.
#[derive(Default)]
struct Groups {
    kind: Kind,
    /// Whether something was added since the last group was closed, be it nothing but empty blobs.
    is_open: bool,
    raw: Vec<u8>,
    /// The groups that are complete.
    count: u32,
    records: Vec<u8>,
    data: Vec<u8>,
}

impl Groups {
    /// The group of some bytes, and where they are in it.
    fn add(&mut self, kind: Kind, bytes: &[u8]) -> Result<[u32; 2], Error> {
        let is_full = !self.raw.is_empty() && self.raw.len() + bytes.len() > GROUP_BYTES;
        if self.is_open && (is_full || kind != self.kind) {
            self.close()?;
        }
        self.kind = kind;
        let place = [self.count, to_u32(self.raw.len())?];
        self.raw.extend_from_slice(bytes);
        self.is_open = true;
        Ok(place)
    }

    fn close(&mut self) -> Result<(), Error> {
        let packed = packing::compress(&self.raw)?;
        self.records.extend_from_slice(&(self.data.len() as u64).to_le_bytes());
        push_words(&mut self.records, &[to_u32(packed.len())?, to_u32(self.raw.len())?]);
        self.records.extend_from_slice(&checksum(&packed));
        self.data.extend_from_slice(&packed);
        self.raw.clear();
        self.is_open = false;
        self.count += 1;
        Ok(())
    }

    /// How many groups there are, their records, and DATA.
    fn finish(mut self) -> Result<(u32, Vec<u8>, Vec<u8>), Error> {
        if self.is_open {
            self.close()?;
        }
        Ok((self.count, self.records, self.data))
    }
}

/// The unit of each key, in the order of the keys, so that neighbours differ little. A unit comes
/// once for each of its keys.
fn in_key_order(entry: &EntryContents) -> impl Iterator<Item = &Unit> {
    entry.keys.values().filter_map(|hash| entry.units.get(hash))
}

/// Builds the hash table of a key set.
fn build_slots(keys: &[&str], count: usize) -> Result<Vec<u128>, Error> {
    let mut slots = vec![0; count];
    for (index, key) in keys.iter().enumerate() {
        let hash = hash_key(key.as_bytes());
        let mut at = hash as usize & (count - 1);
        let mut probes = 1;
        while slots[at] != 0 {
            at = (at + 1) & (count - 1);
            probes += 1;
            if probes > PROBES {
                return Err(Error::Io(format!("too many keys have the hash of `{key}`")));
            }
        }
        slots[at] = hash >> 32 << 32 | u128::from(to_u32(index + 1)?);
    }
    Ok(slots)
}

/// The header and the sections. DATA has no checksum of its own, since each of its groups has one.
fn join_sections(sections: [&[u8]; 6]) -> Result<Vec<u8>, Error> {
    let total = HEADER_BYTES + sections.iter().map(|section| section.len()).sum::<usize>();
    let mut file = Vec::with_capacity(total);
    file.extend_from_slice(MAGIC);
    push_words(&mut file, &[VERSION, to_u32(sections.len())?]);
    file.extend_from_slice(&(total as u64).to_le_bytes());
    let mut at = HEADER_BYTES;
    for (index, section) in sections.iter().enumerate() {
        file.extend_from_slice(&(at as u64).to_le_bytes());
        file.extend_from_slice(&(section.len() as u64).to_le_bytes());
        let is_data = index + 1 == sections.len();
        file.extend_from_slice(&if is_data { [0; 16] } else { checksum(section) });
        at += section.len();
    }
    let header = checksum(&file);
    file.extend_from_slice(&header);
    sections.iter().for_each(|section| file.extend_from_slice(section));
    Ok(file)
}

fn to_value(value: &impl Serialize) -> Result<Value, Error> {
    serde_json::to_value(value).map_err(|error| Error::Io(error.to_string()))
}

fn push_words(bytes: &mut Vec<u8>, words: &[u32]) {
    words.iter().for_each(|word| bytes.extend_from_slice(&word.to_le_bytes()));
}

fn to_u32(value: usize) -> Result<u32, Error> {
    u32::try_from(value).map_err(|_| outgrown())
}

fn outgrown() -> Error {
    Error::Io("a table of the bundle outgrows 32 bits".to_owned())
}
