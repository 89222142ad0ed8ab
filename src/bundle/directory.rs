//! The directory form: `manifest.json` and `blobs/`.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::contents::{checksum, hex};
use super::manifest::{self, Manifest, ManifestArtifact, ManifestUnit};
use super::store::{self, Artifact, Program, Programs, Store};
use super::{Contents, Digest, Error, Native, Reflection, Stage, Unit};

const MANIFEST: &str = "manifest.json";
const BLOBS: &str = "blobs";
const TEMPORARY: &str = ".tmp-";

/// Writes the directory form over whatever bundle is there.
pub fn write_directory(contents: &Contents, path: impl AsRef<Path>) -> Result<(), Error> {
    let writer = DirectoryWriter::create(path)?;
    let entries = contents.programs.values().flat_map(|program| program.languages.values()).flat_map(|entries| entries.values());
    entries.flat_map(|entry| entry.units.values()).try_for_each(|unit| writer.add(unit).map(|_| ()))?;
    writer.finish(contents)
}

/// Writes the directory form over whatever bundle is there, unit by unit, so that no more than
/// its manifest is ever in memory.
///
/// Blobs come first, under names of their own content; then the manifest, by one rename; then
/// blobs nobody names any more are removed. Killed at any point, the directory is the old bundle
/// or the new one, whole.
pub struct DirectoryWriter {
    path: PathBuf,
    /// Held until the writer is gone.
    _turn: Option<fs::File>,
    manifest: Mutex<Manifest>,
}

impl DirectoryWriter {
    /// Starts over at `path`; the bundle that is there stays as it is until [`Self::finish`].
    pub fn create(path: impl AsRef<Path>) -> Result<Self, Error> {
        let path = path.as_ref().to_owned();
        fs::create_dir_all(path.join(BLOBS))?;
        let turn = turn(&path);
        Ok(Self { path, _turn: turn, manifest: Mutex::default() })
    }

    /// Writes the blobs of a unit; keys refer to it by the digest's hash.
    pub fn add(&self, unit: &Unit) -> Result<Digest, Error> {
        let digest = unit.digest()?;
        let mut part = Manifest::default();
        part.add_unit(&digest, unit)?;
        for (target, named) in part.units.values().flat_map(|unit| &unit.targets) {
            if let Some(artifact) = unit.targets.get(target) {
                replace(&self.path.join(BLOBS).join(named.file()?), &artifact.bytes)?;
            }
        }
        self.manifest().absorb(part);
        Ok(digest)
    }

    /// Writes the manifest for the programs and keys of `contents`, whose own units are not
    /// looked at, and removes what is no longer named.
    ///
    /// # Errors
    /// [`Error::Corrupt`] where a key refers to a unit that was not added.
    pub fn finish(self, contents: &Contents) -> Result<(), Error> {
        let mut manifest = std::mem::take(&mut *self.manifest());
        manifest.outline(contents)?;
        self.write(&manifest)?;
        let artifacts = manifest.units.values().flat_map(|unit| unit.targets.values());
        let names = artifacts.map(ManifestArtifact::file).collect::<Result<BTreeSet<_>, _>>()?;
        remove_stale(&self.path.join(BLOBS), &names)
    }

    /// Goes on with the bundle at `path`.
    pub(super) fn reopen(path: impl AsRef<Path>) -> Result<Self, Error> {
        let path = path.as_ref().to_owned();
        let turn = turn(&path);
        let manifest = read_manifest(&path)?;
        Ok(Self { path, _turn: turn, manifest: Mutex::new(manifest) })
    }

    /// Sets the keys of `contents` and leaves all others as they are.
    pub(super) fn patch(self, contents: &Contents) -> Result<(), Error> {
        let mut manifest = std::mem::take(&mut *self.manifest());
        let mut others = std::mem::take(&mut manifest.programs);
        manifest.outline(contents)?;
        let patches = std::mem::take(&mut manifest.programs);
        for (name, patch) in patches {
            let program = others.entry(name).or_default();
            program.axes = patch.axes;
            for (language, entries) in patch.entries {
                for (entry, patch) in entries {
                    program.entries.entry(language).or_default().entry(entry).or_default().keys.extend(patch.keys);
                }
            }
        }
        manifest.programs = others;
        self.write(&manifest)
    }

    fn write(&self, manifest: &Manifest) -> Result<(), Error> {
        let path = self.path.join(MANIFEST);
        let temporary = temporary(&path);
        let written = fs::File::create(&temporary).map_err(Error::from).and_then(|file| manifest::write(manifest, file));
        let renamed = written.and_then(|()| Ok(fs::rename(&temporary, path)?));
        if renamed.is_err() {
            // The error that matters is the first one.
            let _ = fs::remove_file(&temporary);
        }
        renamed
    }

    fn manifest(&self) -> MutexGuard<'_, Manifest> {
        // A thread that panicked here left the manifest without its unit, which no key names.
        self.manifest.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Waits until no other run writes there: one would remove what the other is about to name.
/// The system ends a turn with its process. Where folders cannot be locked there are no turns.
fn turn(path: &Path) -> Option<fs::File> {
    let folder = fs::File::open(path).ok()?;
    folder.lock().ok()?;
    Some(folder)
}

/// Writes a file beside and renames it into place, unless it is there with these bytes already.
pub fn replace(path: &Path, bytes: &[u8]) -> Result<(), Error> {
    if fs::metadata(path).is_ok_and(|found| found.len() == bytes.len() as u64) && fs::read(path).is_ok_and(|found| found == bytes) {
        return Ok(());
    }
    let temporary = temporary(path);
    let written = fs::write(&temporary, bytes).and_then(|()| fs::rename(&temporary, path));
    if written.is_err() {
        // The error that matters is the first one.
        let _ = fs::remove_file(&temporary);
    }
    Ok(written?)
}

/// A name beside `path` that no other thread or process uses.
fn temporary(path: &Path) -> PathBuf {
    static NEXT: AtomicU32 = AtomicU32::new(0);
    path.with_file_name(format!("{TEMPORARY}{}-{}", std::process::id(), NEXT.fetch_add(1, Ordering::Relaxed)))
}

/// Removes blobs that are not named, and what a killed run left.
fn remove_stale(blobs: &Path, names: &BTreeSet<String>) -> Result<(), Error> {
    for entry in fs::read_dir(blobs)? {
        let entry = entry?;
        let is_named = entry.file_name().to_str().is_some_and(|name| names.contains(name));
        if !is_named && entry.file_type()?.is_file() {
            fs::remove_file(entry.path())?;
        }
    }
    Ok(())
}

/// Artifacts by target, each with the number of its blob.
type Numbered = BTreeMap<String, (ManifestArtifact, u32)>;

/// An open directory; blobs are read when asked for.
pub struct Directory {
    blobs: PathBuf,
    programs: Programs,
    /// By number of the entry point.
    keys: Vec<BTreeMap<String, u32>>,
    units: Vec<(Arc<Reflection>, Numbered)>,
    natives: BTreeMap<String, Arc<Native>>,
    /// By number of the blob.
    artifacts: Vec<ManifestArtifact>,
}

fn read_manifest(path: &Path) -> Result<Manifest, Error> {
    let text = fs::read(path.join(MANIFEST)).map_err(|error| Error::Io(format!("{MANIFEST}: {error}")))?;
    manifest::read(&String::from_utf8(text).map_err(|_| Error::corrupt(MANIFEST, "it is not UTF-8"))?)
}

/// Reads the manifest.
pub fn open(path: &Path) -> Result<Directory, Error> {
    let manifest = read_manifest(path)?;
    let mut directory = Directory {
        blobs: path.join(BLOBS),
        programs: Programs::new(),
        keys: Vec::new(),
        units: Vec::new(),
        natives: manifest.natives.into_iter().map(|(name, native)| (name, Arc::new(native))).collect(),
        artifacts: Vec::new(),
    };
    let reflections: BTreeMap<_, _> = manifest.reflections.into_iter().map(|(name, reflection)| (name, Arc::new(reflection))).collect();
    let mut numbers = BTreeMap::new();
    for (name, unit) in manifest.units {
        numbers.insert(name, directory.units.len() as u32);
        directory.add_unit(unit, &reflections)?;
    }
    for (name, program) in manifest.programs {
        let mut index = Program { axes: program.axes, ..Program::default() };
        for (language, entries) in program.entries {
            for (entry, contents) in entries {
                index.entries.insert((language, entry), directory.keys.len());
                let number = |(key, unit)| Some((key, *numbers.get(&unit)?));
                let keys: Option<_> = contents.keys.into_iter().map(number).collect();
                directory.keys.push(keys.ok_or_else(|| Error::corrupt(MANIFEST, "a key names no unit"))?);
            }
        }
        directory.programs.insert(name, index);
    }
    Ok(directory)
}

/// A file of a directory bundle: what wrote it, and for which stage.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct BlobFile {
    pub target: String,
    pub stage: Stage,
    pub path: PathBuf,
}

/// Every distinct blob of a directory bundle: for tools that take files.
pub fn blob_files(path: impl AsRef<Path>) -> Result<BTreeSet<BlobFile>, Error> {
    let directory = open(path.as_ref())?;
    let mut files = BTreeSet::new();
    for (reflection, targets) in &directory.units {
        for (target, (artifact, _)) in targets {
            files.insert(BlobFile { target: target.clone(), stage: reflection.stage, path: directory.blobs.join(artifact.file()?) });
        }
    }
    Ok(files)
}

impl Directory {
    fn add_unit(&mut self, unit: ManifestUnit, reflections: &BTreeMap<String, Arc<Reflection>>) -> Result<(), Error> {
        let reflection = reflections.get(&unit.reflection).ok_or_else(|| Error::corrupt(MANIFEST, "a unit names no reflection"))?;
        let mut targets = BTreeMap::new();
        for (target, artifact) in unit.targets {
            artifact.file()?;
            self.artifacts.push(artifact.clone());
            targets.insert(target, (artifact, self.artifacts.len() as u32 - 1));
        }
        self.units.push((reflection.clone(), targets));
        Ok(())
    }

    fn entry(&self, entry: usize) -> Result<&BTreeMap<String, u32>, Error> {
        self.keys.get(entry).ok_or_else(|| Error::corrupt(MANIFEST, "an entry point is out of range"))
    }
}

impl Store for Directory {
    fn programs(&self) -> &Programs {
        &self.programs
    }

    fn find(&self, entry: usize, key: &str) -> Result<Option<u32>, Error> {
        Ok(self.entry(entry)?.get(key).copied())
    }

    fn each_key(&self, entry: usize, visit: &mut dyn FnMut(&str, u32)) -> Result<(), Error> {
        self.entry(entry)?.iter().for_each(|(key, unit)| visit(key, *unit));
        Ok(())
    }

    fn unit(&self, unit: u32) -> Result<store::Unit, Error> {
        let (reflection, targets) = self.units.get(unit as usize).ok_or_else(|| Error::corrupt(MANIFEST, "a unit is out of range"))?;
        let targets = targets.iter().map(|(target, (artifact, blob))| {
            let native = self.natives.get(&artifact.native).ok_or_else(|| Error::corrupt(MANIFEST, "an artifact names no native"))?;
            Ok((target.clone(), Artifact { extension: artifact.extension.clone(), native: native.clone(), blob: *blob }))
        });
        Ok(store::Unit { reflection: reflection.clone(), targets: targets.collect::<Result<_, Error>>()? })
    }

    fn blob(&self, blob: u32) -> Result<Vec<u8>, Error> {
        let artifact = self.artifacts.get(blob as usize).ok_or_else(|| Error::corrupt(MANIFEST, "a blob is out of range"))?;
        let name = artifact.file()?;
        let path = self.blobs.join(&name);
        let part = format!("{BLOBS}/{name}");
        let metadata = fs::metadata(&path).map_err(|error| Error::Io(format!("{part}: {error}")))?;
        if metadata.len() != artifact.bytes {
            return Err(Error::corrupt(part, format!("it has {} bytes, not {}", metadata.len(), artifact.bytes)));
        }
        let bytes = fs::read(&path).map_err(|error| Error::Io(format!("{part}: {error}")))?;
        if hex(&checksum(&bytes)) == artifact.blob { Ok(bytes) } else { Err(Error::corrupt(part, "the checksum does not match")) }
    }

    fn verify(&self) -> Result<(), Error> {
        let distinct: BTreeMap<&ManifestArtifact, u32> = self.artifacts.iter().zip(0..).collect();
        distinct.values().try_for_each(|blob| self.blob(*blob).map(|_| ()))?;
        (0..self.units.len() as u32).try_for_each(|unit| self.unit(unit).map(|_| ()))
    }
}
