//! The directory form: `manifest.json` and `blobs/`.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::contents::{checksum, from_hex, refuse_control_characters, to_hex};
use super::layout::MOST_GROUP_BYTES;
use super::manifest::{self, Manifest, ManifestArtifact, ManifestUnit, blob_file_name};
use super::pack::pack_index;
use super::store::{self, Store, StoredArtifact, StoredProgram, StoredPrograms};
use super::{Axis, Error, Hash, Native, Reflection, ShardOrigin, Stage, file};
use lamplight_files::input;

pub(super) const MANIFEST: &str = "manifest.json";
/// The binary form of the manifest, for readers that read no JSON: see [`super::layout`].
pub(super) const INDEX: &str = "index.bin";
pub(super) const BLOBS: &str = "blobs";

/// The most bytes of a manifest: forty times what 100,000 permutations need.
pub(super) const MOST_MANIFEST_BYTES: u64 = lamplight_files::limits::MANIFEST_BYTES;

/// Artifacts by target, each with the index of its blob.
type NumberedArtifacts = BTreeMap<String, (ManifestArtifact, u32)>;

/// An open directory; blobs are read when asked for.
pub struct Directory {
    path: PathBuf,
    blobs: PathBuf,
    programs: StoredPrograms,
    shard: Option<ShardOrigin>,
    /// For each entry point, the unit of each key.
    keys: Vec<BTreeMap<String, u32>>,
    units: Vec<(Arc<Reflection>, NumberedArtifacts)>,
    natives: BTreeMap<String, Arc<Native>>,
    /// The blobs, each distinct one once.
    artifacts: Vec<ManifestArtifact>,
    numbers: BTreeMap<ManifestArtifact, u32>,
}

/// The manifest of a directory.
pub(super) fn read_manifest(path: &Path) -> Result<Manifest, Error> {
    let text = input::read_file(&path.join(MANIFEST), MOST_MANIFEST_BYTES)
        .map_err(|error| Error::Io(format!("{MANIFEST}: {error}")))?;
    manifest::read_manifest(
        &String::from_utf8(text).map_err(|_| Error::corrupt(MANIFEST, "it is not UTF-8"))?,
    )
}

/// Reads the manifest.
pub fn open(path: &Path) -> Result<Directory, Error> {
    let manifest = read_manifest(path)?;
    let mut directory = Directory {
        path: path.to_owned(),
        blobs: path.join(BLOBS),
        programs: StoredPrograms::new(),
        shard: manifest.shard,
        keys: Vec::new(),
        units: Vec::new(),
        natives: manifest
            .natives
            .into_iter()
            .map(|(name, native)| (name, Arc::new(native)))
            .collect(),
        artifacts: Vec::new(),
        numbers: BTreeMap::new(),
    };
    let reflections: BTreeMap<_, _> = manifest
        .reflections
        .into_iter()
        .map(|(name, reflection)| (name, Arc::new(reflection)))
        .collect();
    let mut numbers = BTreeMap::new();
    for (name, unit) in manifest.units {
        numbers.insert(name, directory.units.len() as u32);
        directory.add_unit(unit, &reflections)?;
    }
    for (name, program) in manifest.programs {
        let entries = program.entries.values().flat_map(BTreeMap::keys);
        refuse_control_characters(MANIFEST, std::iter::once(&name).chain(entries))?;
        refuse_control_characters(MANIFEST, program.axes.iter().flat_map(Axis::names))?;
        let mut index = StoredProgram {
            axes: program.axes,
            layouts: program.layouts,
            ..StoredProgram::default()
        };
        for (language, entries) in program.entries {
            for (entry, contents) in entries {
                index.entries.insert((language, entry), directory.keys.len());
                let number = |(key, unit)| Some((key, *numbers.get(&unit)?));
                let keys: Option<_> = contents.keys.into_iter().map(number).collect();
                directory
                    .keys
                    .push(keys.ok_or_else(|| Error::corrupt(MANIFEST, "a key names no unit"))?);
            }
        }
        directory.programs.insert(name, index);
    }
    Ok(directory)
}

/// The file of one blob of a directory bundle, with its target and its stage.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct BlobFile {
    /// Name of the target.
    pub target: String,
    /// Stage of the entry point.
    pub stage: Stage,
    /// Name of the entry point in the output.
    pub entry: String,
    /// The file.
    pub path: PathBuf,
    /// A unit that has this blob.
    pub unit: Hash,
    /// What the bundle says of the entry point.
    pub reflection: Arc<Reflection>,
    /// What the bundle says of the entry point in this target.
    pub native: Arc<Native>,
    /// The names of both in the manifest, which are hashes of their content.
    pub description: String,
}

/// Every distinct blob of a directory bundle: for tools that take files. A blob that the bundle
/// describes in several ways is listed with each.
pub fn blob_files(path: impl AsRef<Path>) -> Result<BTreeSet<BlobFile>, Error> {
    let path = path.as_ref();
    blob_files_of_manifest(&read_manifest(path)?, &|name| path.join(BLOBS).join(name))
}

/// The distinct blobs of a manifest. `place` returns the path of a blob's file, given its name.
pub(super) fn blob_files_of_manifest(
    manifest: &Manifest,
    place: &dyn Fn(&str) -> PathBuf,
) -> Result<BTreeSet<BlobFile>, Error> {
    let lost = |what: &str| Error::corrupt(MANIFEST, format!("a unit names no {what}"));
    let (reflections, natives) =
        (shared_values(&manifest.reflections), shared_values(&manifest.natives));
    let mut files = BTreeMap::new();
    for (name, unit) in &manifest.units {
        let reflection = reflections.get(&unit.reflection).ok_or_else(|| lost("reflection"))?;
        let hash = from_hex(name).ok_or_else(|| Error::corrupt(MANIFEST, "a unit has no name"))?;
        for (target, artifact) in &unit.targets {
            let native = natives.get(&artifact.native).ok_or_else(|| lost("native"))?;
            let described = (&unit.reflection, &artifact.native);
            let file = artifact.file()?;
            files.entry((target, file, described)).or_insert_with_key(|(_, file, _)| BlobFile {
                target: target.clone(),
                stage: reflection.stage,
                entry: native.entry_name.clone(),
                path: place(file),
                unit: hash,
                reflection: reflection.clone(),
                native: native.clone(),
                description: format!("{}-{}", unit.reflection, artifact.native),
            });
        }
    }
    Ok(files.into_values().collect())
}

/// The values of a table, each once in memory however many refer to it.
fn shared_values<T: Clone>(values: &BTreeMap<String, T>) -> BTreeMap<&String, Arc<T>> {
    values.iter().map(|(name, value)| (name, Arc::new(value.clone()))).collect()
}

impl Directory {
    fn add_unit(
        &mut self,
        unit: ManifestUnit,
        reflections: &BTreeMap<String, Arc<Reflection>>,
    ) -> Result<(), Error> {
        let reflection = reflections
            .get(&unit.reflection)
            .ok_or_else(|| Error::corrupt(MANIFEST, "a unit names no reflection"))?;
        let mut targets = BTreeMap::new();
        refuse_control_characters(MANIFEST, unit.targets.keys())?;
        for (target, artifact) in unit.targets {
            artifact.file()?;
            let next = self.artifacts.len() as u32;
            let number = *self.numbers.entry(artifact.clone()).or_insert(next);
            if number == next {
                self.artifacts.push(artifact.clone());
            }
            targets.insert(target, (artifact, number));
        }
        self.units.push((reflection.clone(), targets));
        Ok(())
    }

    fn entry(&self, entry: usize) -> Result<&BTreeMap<String, u32>, Error> {
        self.keys
            .get(entry)
            .ok_or_else(|| Error::corrupt(MANIFEST, "an entry point is out of range"))
    }

    /// Reads every blob, on several threads: most of the time is spent in opening files.
    ///
    /// # Errors
    /// That of the first blob which has one.
    fn verify_blobs(&self) -> Result<(), Error> {
        let count = self.artifacts.len() as u32;
        let threads = std::thread::available_parallelism().map_or(1, usize::from) as u32;
        let part = count.div_ceil(threads).max(LEAST_PART);
        let verify = |from: u32| -> Result<(), Error> {
            let mut blobs = from..count.min(from.saturating_add(part));
            blobs.try_for_each(|blob| self.blob(blob).map(|_| ()))
        };
        std::thread::scope(|scope| {
            let start = |from| {
                let spawned = std::thread::Builder::new().spawn_scoped(scope, move || verify(from));
                // A system that gives no more threads does the work on this one.
                spawned.map_err(|_| from)
            };
            let works: Vec<_> = (0..count).step_by(part as usize).map(start).collect();
            works.into_iter().try_for_each(|work| match work {
                Ok(thread) => {
                    thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
                }
                Err(from) => verify(from),
            })
        })
    }

    /// Refuses the index of another bundle that is not whole.
    fn verify_other_index(&self, index: Vec<u8>) -> Result<(), Error> {
        for (blob, name) in blobs_of_index(index)? {
            let part = format!("{BLOBS}/{name}");
            let bytes = input::read_file(&self.blobs.join(&name), MOST_GROUP_BYTES as u64)
                .map_err(|error| Error::Io(format!("{part}: {error}")))?;
            if to_hex(&checksum(&bytes)) != blob {
                return Err(Error::corrupt(part, "the checksum does not match"));
            }
        }
        Ok(())
    }
}

/// The checksums of the blobs that an index names, each with the name of its file.
fn blobs_of_index(index: Vec<u8>) -> Result<Vec<(String, String)>, Error> {
    let index = file::from_bytes(index)?;
    index.verify_index()?;
    let named = index.outputs()?.into_iter().map(|(blob, extension)| {
        let name = blob_file_name(&blob, &extension)
            .ok_or_else(|| Error::corrupt(INDEX, format!("`{blob}` does not name a blob")))?;
        Ok((blob, name))
    });
    named.collect()
}

/// The files of the blobs that an index names.
pub(super) fn blob_files_of_index(index: Vec<u8>) -> Result<BTreeSet<String>, Error> {
    Ok(blobs_of_index(index)?.into_iter().map(|(_, name)| name).collect())
}

/// How many blobs a thread reads at least.
const LEAST_PART: u32 = 64;

impl Store for Directory {
    fn programs(&self) -> &StoredPrograms {
        &self.programs
    }

    fn shard(&self) -> Option<&ShardOrigin> {
        self.shard.as_ref()
    }

    fn find(&self, entry: usize, key: &str) -> Result<Option<u32>, Error> {
        Ok(self.entry(entry)?.get(key).copied())
    }

    fn each_key(&self, entry: usize, visit: &mut dyn FnMut(&str, u32)) -> Result<(), Error> {
        self.entry(entry)?.iter().for_each(|(key, unit)| visit(key, *unit));
        Ok(())
    }

    fn unit(&self, unit: u32) -> Result<store::StoredUnit, Error> {
        let (reflection, targets) = self
            .units
            .get(unit as usize)
            .ok_or_else(|| Error::corrupt(MANIFEST, "a unit is out of range"))?;
        let targets = targets.iter().map(|(target, (artifact, blob))| {
            let native = self
                .natives
                .get(&artifact.native)
                .ok_or_else(|| Error::corrupt(MANIFEST, "an artifact names no native"))?;
            Ok((
                target.clone(),
                StoredArtifact {
                    extension: artifact.extension.clone(),
                    native: native.clone(),
                    blob: *blob,
                },
            ))
        });
        Ok(store::StoredUnit {
            reflection: reflection.clone(),
            targets: targets.collect::<Result<_, Error>>()?,
        })
    }

    fn digest(&self, blob: u32) -> Result<String, Error> {
        let artifact = self.artifacts.get(blob as usize);
        let artifact =
            artifact.ok_or_else(|| Error::corrupt(MANIFEST, "a blob is out of range"))?;
        Ok(artifact.blob.clone())
    }

    fn blob(&self, blob: u32) -> Result<Vec<u8>, Error> {
        let artifact = self
            .artifacts
            .get(blob as usize)
            .ok_or_else(|| Error::corrupt(MANIFEST, "a blob is out of range"))?;
        let name = artifact.file()?;
        let path = self.blobs.join(&name);
        let part = format!("{BLOBS}/{name}");
        let io = |error| Error::Io(format!("{part}: {error}"));
        let found = input::open_file(&path).and_then(|file| file.metadata()).map_err(io)?.len();
        if found != artifact.bytes {
            let words = format!("it has {found} bytes, not {}", artifact.bytes);
            return Err(Error::corrupt(part, words));
        }
        let bytes = input::read_file(&path, found.min(MOST_GROUP_BYTES as u64)).map_err(io)?;
        if to_hex(&checksum(&bytes)) == artifact.blob {
            Ok(bytes)
        } else {
            Err(Error::corrupt(part, "the checksum does not match"))
        }
    }

    /// Refuses nothing. Each blob is read once, however many units name it, and no blob may be
    /// larger than a group, so the memory is in proportion to the bundle.
    fn measure(&self) -> Result<(), Error> {
        Ok(())
    }

    fn verify(&self) -> Result<(), Error> {
        self.verify_blobs()?;
        (0..self.units.len() as u32).try_for_each(|unit| self.unit(unit).map(|_| ()))?;
        let index = input::read_file(&self.path.join(INDEX), MOST_MANIFEST_BYTES)
            .map_err(|error| Error::Io(format!("{INDEX}: {error}")))?;
        match index == pack_index(&read_manifest(&self.path)?)? {
            true => Ok(()),
            // A run that was stopped between the two has left the index of the next bundle.
            false => self.verify_other_index(index),
        }
    }
}
