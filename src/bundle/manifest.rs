//! `manifest.json` of the directory form.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::contents::{checksum, hex, json};
use super::{Axis, Contents, EntryContents, Error, Language, Native, Reflection, Unit, VERSION};

/// The published JSON Schema of the manifest.
pub const SCHEMA: &str = include_str!("schema.json");

/// How the file ends after the checksum.
const END: &str = "\"\n}\n";
const BLANK: &str = "00000000000000000000000000000000";

/// The whole file. Everything is named by what it is, so that an edit moves no other line.
#[derive(Debug, Default, Serialize, Deserialize)]
pub struct Manifest {
    pub version: u32,
    pub programs: BTreeMap<String, ManifestProgram>,
    pub units: BTreeMap<String, ManifestUnit>,
    pub reflections: BTreeMap<String, Reflection>,
    pub natives: BTreeMap<String, Native>,
    /// Over the text of the file with zeros in its place; the last value of the file.
    pub checksum: String,
}

#[derive(Debug, Default, Serialize, Deserialize)]
pub struct ManifestProgram {
    pub axes: Vec<Axis>,
    pub entries: BTreeMap<Language, BTreeMap<String, ManifestEntry>>,
}

#[derive(Debug, Default, Serialize, Deserialize)]
pub struct ManifestEntry {
    pub keys: BTreeMap<String, String>,
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
    /// The blob's file below `blobs/`, if the parts are what a writer writes.
    pub fn file(&self) -> Result<String, Error> {
        let is_hex = self.blob.len() == 32 && self.blob.bytes().all(|byte| byte.is_ascii_hexdigit());
        let parts = self.extension.split('.');
        if is_hex && parts.clone().all(|part| !part.is_empty() && part.bytes().all(|byte| byte.is_ascii_alphanumeric())) {
            return Ok(format!("{}.{}", &self.blob[..16], self.extension));
        }
        Err(Error::corrupt("manifest.json", format!("`{}` and `{}` do not name a blob", self.blob, self.extension)))
    }
}

/// The text of the manifest.
pub fn write(contents: &Contents) -> Result<String, Error> {
    let mut manifest = Manifest { version: VERSION, checksum: BLANK.to_owned(), ..Manifest::default() };
    for (name, program) in &contents.programs {
        let mut copy = ManifestProgram { axes: program.axes.clone(), ..ManifestProgram::default() };
        for (language, entries) in &program.languages {
            for (entry, contents) in entries {
                let keys = add_units(&mut manifest, contents)?;
                copy.entries.entry(*language).or_default().insert(entry.clone(), ManifestEntry { keys });
            }
        }
        manifest.programs.insert(name.clone(), copy);
    }
    let mut text = serde_json::to_string_pretty(&manifest).map_err(|error| Error::Io(error.to_string()))?;
    text.push('\n');
    let sum = hex(&checksum(text.as_bytes()));
    text.truncate(text.len() - END.len() - BLANK.len());
    Ok(text + &sum + END)
}

/// The manifest, if its text is what was written.
pub fn read(text: &str) -> Result<Manifest, Error> {
    let damaged = |reason: String| Error::corrupt("manifest.json", reason);
    let manifest: Manifest = match serde_json::from_str(text) {
        Ok(manifest) => manifest,
        Err(error) => return Err(version_error(text).unwrap_or_else(|| damaged(error.to_string()))),
    };
    if manifest.version != VERSION {
        return Err(Error::Version { found: manifest.version, known: VERSION });
    }
    let body = text.strip_suffix(END).and_then(|text| text.strip_suffix(manifest.checksum.as_str()));
    let body = body.ok_or_else(|| damaged("the checksum is not at the end".to_owned()))?;
    if hex(&checksum(format!("{body}{BLANK}{END}").as_bytes())) == manifest.checksum {
        Ok(manifest)
    } else {
        Err(damaged("the checksum does not match".to_owned()))
    }
}

/// A manifest of another version need not have this one's fields.
fn version_error(text: &str) -> Option<Error> {
    #[derive(Deserialize)]
    struct OnlyVersion {
        version: u32,
    }
    let found = serde_json::from_str::<OnlyVersion>(text).ok()?.version;
    (found != VERSION).then_some(Error::Version { found, known: VERSION })
}

fn add_units(manifest: &mut Manifest, entry: &EntryContents) -> Result<BTreeMap<String, String>, Error> {
    for (hash, unit) in &entry.units {
        if !manifest.units.contains_key(&hex(hash)) {
            let copy = add_unit(manifest, unit)?;
            manifest.units.insert(hex(hash), copy);
        }
    }
    Ok(entry.keys.iter().map(|(key, hash)| (key.clone(), hex(hash))).collect())
}

fn add_unit(manifest: &mut Manifest, unit: &Unit) -> Result<ManifestUnit, Error> {
    let reflection = hex(&checksum(&json(&*unit.reflection)?));
    manifest.reflections.entry(reflection.clone()).or_insert_with(|| (*unit.reflection).clone());
    let mut targets = BTreeMap::new();
    for (target, artifact) in &unit.targets {
        let native = hex(&checksum(&json(&*artifact.native)?));
        manifest.natives.entry(native.clone()).or_insert_with(|| (*artifact.native).clone());
        let blob = hex(&checksum(&artifact.bytes));
        let bytes = artifact.bytes.len() as u64;
        targets.insert(target.clone(), ManifestArtifact { blob, extension: artifact.extension.clone(), bytes, native });
    }
    Ok(ManifestUnit { reflection, targets })
}
