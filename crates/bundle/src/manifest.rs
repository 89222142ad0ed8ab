//! `manifest.json` of the directory form.

use std::collections::{BTreeMap, BTreeSet};
use std::io::{self, Write as _};
use std::sync::Arc;

use serde::de::IgnoredAny;
use serde::{Deserialize, Serialize};

use super::contents::{checksum, from_hex, shortened_hash, to_hex, to_json};
use super::program_layout::{EntryKeys, program_layout};
use super::store::Layouts;
use super::{
    Artifact, Axis, Constant, Contents, Digest, EntryContents, Error, Hash, Language, Native,
    ProgramContents, Reflection, ShardOrigin, Unit, VERSION,
};

/// The published JSON Schema of the manifest.
pub const SCHEMA: &str = include_str!("schema.json");

/// How the file ends, after the checksum.
const END: &str = "\"\n}\n";
const BLANK: &str = "00000000000000000000000000000000";

/// The whole file. Everything is named by its content, so that a change of one shader does not
/// change other lines.
#[derive(Debug, Serialize, Deserialize)]
pub struct Manifest {
    pub version: u32,
    /// In a part of a bundle only.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shard: Option<ShardOrigin>,
    pub programs: BTreeMap<String, ManifestProgram>,
    pub units: BTreeMap<String, ManifestUnit>,
    pub reflections: BTreeMap<String, Reflection>,
    pub natives: BTreeMap<String, Native>,
    /// Lists of constants, by name.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub constants: BTreeMap<String, Vec<Constant>>,
    /// The checksum of the file's text, in which zeros stand for the checksum itself. It is the
    /// last value of the file.
    pub checksum: String,
}

impl Default for Manifest {
    fn default() -> Self {
        Self {
            version: VERSION,
            shard: None,
            programs: BTreeMap::new(),
            units: BTreeMap::new(),
            reflections: BTreeMap::new(),
            natives: BTreeMap::new(),
            constants: BTreeMap::new(),
            checksum: BLANK.to_owned(),
        }
    }
}

#[derive(Debug, Default, Serialize, Deserialize)]
pub struct ManifestProgram {
    pub axes: Vec<Axis>,
    /// What the permutations bind together, by language.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub layouts: Layouts,
    pub entries: BTreeMap<Language, BTreeMap<String, ManifestEntry>>,
}

#[derive(Debug, Default, Serialize, Deserialize)]
pub struct ManifestEntry {
    pub keys: BTreeMap<String, String>,
    /// For each key that chooses constants, the name of a list of them.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub constants: BTreeMap<String, String>,
}

#[derive(Debug, Default, Serialize, Deserialize)]
pub struct ManifestUnit {
    pub reflection: String,
    pub targets: BTreeMap<String, ManifestArtifact>,
}

#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct ManifestArtifact {
    /// 128 bits of the blob's BLAKE3; the first 64 name its file.
    pub blob: String,
    pub extension: String,
    pub bytes: u64,
    pub native: String,
}

impl ManifestArtifact {
    /// The blob's file below `blobs/`, if the fields are as a writer writes them.
    pub fn file(&self) -> Result<String, Error> {
        blob_file_name(&self.blob, &self.extension).ok_or_else(|| {
            let reason = format!("`{}` and `{}` do not name a blob", self.blob, self.extension);
            Error::corrupt("manifest.json", reason)
        })
    }
}

/// The file of a blob below `blobs/`.
pub fn blob_file_name(blob: &str, extension: &str) -> Option<String> {
    let is_hex = blob.len() == 32 && blob.bytes().all(|byte| byte.is_ascii_hexdigit());
    let mut parts = extension.split('.');
    let is_part =
        |part: &str| !part.is_empty() && part.bytes().all(|byte| byte.is_ascii_alphanumeric());
    (is_hex && parts.all(is_part)).then(|| format!("{}.{extension}", &blob[..16]))
}

/// What stands for the bytes of a blob where they are in a file.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct FileStub {
    /// The hash of the bytes.
    pub hash: Hash,
    /// How many there are.
    pub length: u32,
}

impl FileStub {
    /// The stub as bytes.
    pub fn write(self) -> Vec<u8> {
        [&self.hash[..], &self.length.to_le_bytes()].concat()
    }

    /// Reads what [`Self::write`] wrote.
    pub fn read(bytes: &[u8]) -> Self {
        let read = bytes.split_first_chunk().and_then(|(hash, rest)| {
            let length = u32::from_le_bytes(*rest.first_chunk()?);
            Some(Self { hash: *hash, length })
        });
        read.unwrap_or_default()
    }
}

/// Writes the text of a manifest, with its checksum at the end.
pub fn write_manifest(manifest: &Manifest, out: impl io::Write) -> Result<(), Error> {
    let mut out = io::BufWriter::with_capacity(
        1 << 16,
        Sealing { out, hasher: blake3::Hasher::new(), held: Vec::new() },
    );
    serde_json::to_writer_pretty(&mut out, manifest)
        .map_err(|error| Error::Io(error.to_string()))?;
    out.write_all(b"\n")?;
    out.into_inner().map_err(|error| Error::Io(error.to_string()))?.seal()
}

/// Passes a text on and hashes it, but holds back its end, so that [`Self::seal`] can write the
/// checksum there.
struct Sealing<W> {
    out: W,
    hasher: blake3::Hasher,
    held: Vec<u8>,
}

impl<W: io::Write> io::Write for Sealing<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.held.extend_from_slice(bytes);
        let passed = self.held.len().saturating_sub(BLANK.len() + END.len());
        self.hasher.update(&self.held[..passed]);
        self.out.write_all(&self.held[..passed])?;
        self.held.drain(..passed);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}

impl<W: io::Write> Sealing<W> {
    fn seal(mut self) -> Result<(), Error> {
        self.hasher.update(&self.held);
        let sum = to_hex(&shortened_hash(&self.hasher.finalize()));
        self.out.write_all(sum.as_bytes())?;
        self.out.write_all(END.as_bytes())?;
        Ok(self.out.flush()?)
    }
}

/// Reads a manifest whose checksum is right.
pub fn read_manifest(text: &str) -> Result<Manifest, Error> {
    let damaged = |reason: String| Error::corrupt("manifest.json", reason);
    let manifest: Manifest = match serde_json::from_str(text) {
        Ok(manifest) => manifest,
        Err(error) => return Err(version_error(text).unwrap_or_else(|| damaged(error.to_string()))),
    };
    if manifest.version != VERSION {
        return Err(Error::Version { found: manifest.version, known: VERSION });
    }
    match is_sealed(text, &manifest.checksum) {
        Some(true) => Ok(manifest),
        Some(false) => Err(damaged("the checksum does not match".to_owned())),
        None => Err(damaged("the checksum is not at the end".to_owned())),
    }
}

/// Whether the checksum is that of the text; `None` if it is not at the end.
fn is_sealed(text: &str, sum: &str) -> Option<bool> {
    let body = text.strip_suffix(END)?.strip_suffix(sum)?;
    Some(to_hex(&checksum(format!("{body}{BLANK}{END}").as_bytes())) == sum)
}

/// What a writer must know about the manifest that it will replace.
pub enum Before {
    /// An undamaged manifest, with the files of its blobs.
    Whole(BTreeSet<String>),
    /// One of ours that is damaged or of an older version.
    Unreadable,
    /// One of ours, or of a program that came after us, with its version.
    Newer(u32),
    /// A file of somebody else.
    Foreign,
}

/// The parts of a manifest that every version has, and by which a file is recognised as one.
#[derive(Deserialize)]
struct ManifestMark {
    version: u32,
    #[serde(rename = "programs")]
    _programs: BTreeMap<String, IgnoredAny>,
    checksum: String,
    #[serde(default)]
    units: Option<BTreeMap<String, MarkUnit>>,
}

#[derive(Deserialize)]
struct MarkUnit {
    targets: BTreeMap<String, MarkArtifact>,
}

#[derive(Deserialize)]
struct MarkArtifact {
    blob: String,
    extension: String,
}

/// Whether the text of a file with the name of a manifest is one of ours.
pub fn kind_of_manifest(text: &[u8]) -> Before {
    let text = &*String::from_utf8_lossy(text);
    let Ok(mark) = serde_json::from_str::<ManifestMark>(text) else {
        return if is_marked(text) { Before::Unreadable } else { Before::Foreign };
    };
    let is_hex = mark.checksum.len() == 32 && mark.checksum.bytes().all(|c| c.is_ascii_hexdigit());
    match (is_sealed(text, &mark.checksum), mark.units) {
        _ if !is_hex => Before::Foreign,
        _ if mark.version > VERSION => Before::Newer(mark.version),
        (Some(true), Some(units)) => {
            let artifacts = units.values().flat_map(|unit| unit.targets.values());
            let files = artifacts.filter_map(|found| blob_file_name(&found.blob, &found.extension));
            Before::Whole(files.collect())
        }
        _ => Before::Unreadable,
    }
}

/// Whether a text begins or ends as a manifest does: one that was cut off, or edited badly.
fn is_marked(text: &str) -> bool {
    let begins = text.starts_with("{\n  \"version\": ") && text.contains("\n  \"programs\": {");
    let ends = text.strip_suffix(END).is_some_and(|text| {
        text.rsplit_once("\n  \"checksum\": \"").is_some_and(|(_, sum)| sum.len() == BLANK.len())
    });
    begins || ends
}

/// The error for a manifest of another version, which need not have this version's fields. `None`
/// if the version is not the reason.
fn version_error(text: &str) -> Option<Error> {
    #[derive(Deserialize)]
    struct OnlyVersion {
        version: u32,
    }
    let found = serde_json::from_str::<OnlyVersion>(text).ok()?.version;
    (found != VERSION).then_some(Error::Version { found, known: VERSION })
}

impl Manifest {
    /// Adds a unit under its hash, unless it is there.
    pub fn add_unit(&mut self, digest: &Digest, unit: &Unit) -> Result<(), Error> {
        let name = to_hex(&digest.unit);
        if self.units.contains_key(&name) {
            return Ok(());
        }
        let reflection = to_hex(&digest.reflection);
        self.reflections.entry(reflection.clone()).or_insert_with(|| (*unit.reflection).clone());
        let mut targets = BTreeMap::new();
        for ((target, artifact), found) in unit.targets.iter().zip(&digest.targets) {
            let native = to_hex(&found.native);
            self.natives.entry(native.clone()).or_insert_with(|| (*artifact.native).clone());
            let (blob, bytes, extension) =
                (to_hex(&found.blob), found.length.into(), artifact.extension.clone());
            targets.insert(target.clone(), ManifestArtifact { blob, extension, bytes, native });
        }
        self.units.insert(name, ManifestUnit { reflection, targets });
        Ok(())
    }

    /// Sets the programs, and the keys with the units they refer to.
    pub fn outline(&mut self, contents: &Contents) -> Result<(), Error> {
        let Contents { programs, shard } = contents;
        self.shard.clone_from(shard);
        for (name, program) in programs {
            let mut copy =
                ManifestProgram { axes: program.axes.clone(), ..ManifestProgram::default() };
            for (language, entries) in &program.languages {
                for (entry, contents) in entries {
                    let keys = contents
                        .keys
                        .iter()
                        .map(|(key, hash)| Ok((key.clone(), self.known(hash)?)));
                    let keys = keys.collect::<Result<_, Error>>()?;
                    copy.entries
                        .entry(*language)
                        .or_default()
                        .insert(entry.clone(), ManifestEntry { keys, ..ManifestEntry::default() });
                }
            }
            self.programs.insert(name.clone(), copy);
        }
        Ok(())
    }

    /// Derives what depends on all units of a program: its layouts, and the constants of its keys.
    ///
    /// # Errors
    /// [`Error::Corrupt`] where a key refers to a unit, or a unit to a reflection, that is not there.
    pub fn complete(&mut self) -> Result<(), Error> {
        let Self { programs, units, reflections, constants, .. } = self;
        constants.clear();
        let lost = || Error::corrupt("contents", "a key refers to no unit");
        for program in programs.values_mut() {
            let ManifestProgram { axes, layouts, entries } = program;
            layouts.clear();
            for (language, entries) in entries {
                let mut all = Vec::new();
                for ManifestEntry { keys, constants: chosen } in entries.values_mut() {
                    let mut found = Vec::with_capacity(keys.len());
                    for (key, unit) in keys.iter() {
                        let unit = units.get(unit).ok_or_else(lost)?;
                        let reflection = reflections.get(&unit.reflection).ok_or_else(lost)?;
                        found.push((key.as_str(), reflection));
                    }
                    let grouped = EntryKeys::new(found.into_iter());
                    chosen.clear();
                    for (key, list) in grouped.constants(axes)? {
                        let name = to_hex(&checksum(&to_json(&list)?));
                        chosen.insert(key.to_owned(), name.clone());
                        constants.entry(name).or_insert(list);
                    }
                    all.push(grouped);
                }
                layouts.insert(*language, program_layout(axes, &all));
            }
        }
        Ok(())
    }

    /// The contents, with a [`FileStub`] in the place of the bytes of each blob.
    pub fn contents(&self) -> Result<Contents, Error> {
        let lost = || Error::corrupt("manifest.json", "a name is not there");
        let natives: BTreeMap<_, _> =
            self.natives.iter().map(|(name, native)| (name, Arc::new(native.clone()))).collect();
        let mut units = BTreeMap::new();
        for (name, unit) in &self.units {
            let reflection = self.reflections.get(&unit.reflection).ok_or_else(lost)?;
            let mut targets = BTreeMap::new();
            for (target, artifact) in &unit.targets {
                let hash = from_hex(&artifact.blob).ok_or_else(lost)?;
                let length = u32::try_from(artifact.bytes).map_err(|_| lost())?;
                let native = natives.get(&artifact.native).ok_or_else(lost)?.clone();
                let extension = artifact.extension.clone();
                let bytes = FileStub { hash, length }.write().into();
                targets.insert(target.clone(), Artifact { bytes, extension, native });
            }
            let unit = Unit { reflection: Arc::new(reflection.clone()), targets };
            units.insert(name, (from_hex(name).ok_or_else(lost)?, unit));
        }
        let mut contents = Contents { shard: self.shard.clone(), ..Contents::default() };
        for (name, program) in &self.programs {
            let mut copy = ProgramContents { axes: program.axes.clone(), ..Default::default() };
            for (language, entries) in &program.entries {
                for (entry, found) in entries {
                    let mut filled = EntryContents::default();
                    for (key, unit) in &found.keys {
                        let (hash, unit) = units.get(unit).ok_or_else(lost)?;
                        filled.keys.insert(key.clone(), *hash);
                        filled.units.entry(*hash).or_insert_with(|| unit.clone());
                    }
                    copy.languages.entry(*language).or_default().insert(entry.clone(), filled);
                }
            }
            contents.programs.insert(name.clone(), copy);
        }
        Ok(contents)
    }

    /// Adds the units of another manifest, with their reflections and natives.
    pub fn absorb(&mut self, other: Self) {
        self.units.extend(other.units);
        self.reflections.extend(other.reflections);
        self.natives.extend(other.natives);
    }

    fn known(&self, hash: &Hash) -> Result<String, Error> {
        let name = to_hex(hash);
        if self.units.contains_key(&name) {
            Ok(name)
        } else {
            Err(Error::corrupt("contents", "a key refers to no unit"))
        }
    }
}
