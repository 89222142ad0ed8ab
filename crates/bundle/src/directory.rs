//! The directory form: `index.bin`, `manifest.json` and `blobs/`.
//!
//! Readers open the index, which has the tables of the single file. The manifest says the same to
//! people, and to programs that write bundles.

use std::collections::{BTreeMap, BTreeSet};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

use super::contents::{checksum, from_hex, to_hex};
use super::file::{self, Packed};
use super::layout::MOST_GROUP_BYTES;
use super::manifest::{self, Manifest, blob_file_name};
use super::pack::{pack_index, pack_outputs};
use super::store::{Store, StoredArtifact, StoredPrograms, StoredUnit};
use super::{Error, Hash, Native, Reflection, ShardOrigin, Stage};
use lamplight_files::input;

pub(super) const MANIFEST: &str = "manifest.json";
/// The binary form of the manifest, for readers that read no JSON: see [`super::layout`].
pub(super) const INDEX: &str = "index.bin";
pub(super) const BLOBS: &str = "blobs";

/// The most bytes of a manifest: forty times what 100,000 permutations need.
pub(super) const MOST_MANIFEST_BYTES: u64 = lamplight_files::limits::MANIFEST_BYTES;

/// An open directory. Its tables are read when they are needed, and a blob when it is asked for.
pub struct Directory {
    path: PathBuf,
    index: Packed,
    /// Of each blob, the target that it is for, which says how its file ends.
    targets: OnceLock<Result<Vec<u32>, Error>>,
}

/// The manifest of a directory.
pub(super) fn read_manifest(path: &Path) -> Result<Manifest, Error> {
    let text = input::read_file(&path.join(MANIFEST), MOST_MANIFEST_BYTES)
        .map_err(|error| Error::Io(format!("{MANIFEST}: {error}")))?;
    manifest::read_manifest(
        &String::from_utf8(text).map_err(|_| Error::corrupt(MANIFEST, "it is not UTF-8"))?,
    )
}

/// Opens the index.
pub fn open(path: &Path) -> Result<Directory, Error> {
    let index = path.join(INDEX);
    match file::open(&index) {
        Ok(index) => Ok(Directory { path: path.to_owned(), index, targets: OnceLock::new() }),
        // A bundle of a version that had no index names its version, and what is no bundle at all
        // lacks a manifest too.
        Err(_) if !index.exists() => {
            read_manifest(path)?;
            Err(Error::Io(format!("{INDEX}: {}", std::io::Error::from(ErrorKind::NotFound))))
        }
        Err(error) => Err(error),
    }
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
    /// The file of a blob.
    fn file_of(&self, blob: u32) -> Result<String, Error> {
        let targets = self.targets.get_or_init(|| self.index.targets_of_blobs());
        let target = targets.as_ref().map_err(Clone::clone)?.get(blob as usize);
        let target = target.ok_or_else(|| Error::corrupt(INDEX, "a blob is out of range"))?;
        file_of_index(&self.index, blob, *target)
    }
}

/// The file of a blob of an index.
fn file_of_index(index: &Packed, blob: u32, target: u32) -> Result<String, Error> {
    let (hash, extension) = (index.digest(blob)?, index.extension(target)?);
    blob_file_name(&hash, extension).ok_or_else(|| {
        Error::corrupt(INDEX, format!("`{hash}` and `{extension}` do not name a blob"))
    })
}

/// A blob that some table names: its checksum, its length, and its file below `blobs/`.
type NamedBlob = (String, u64, String);

/// The blobs that an index names.
fn blobs_of_index(index: &Packed) -> Result<BTreeSet<NamedBlob>, Error> {
    index.verify_index()?;
    let named = (0..).zip(index.targets_of_blobs()?).map(|(blob, target)| {
        let length = index.blob_record(blob)?.length as u64;
        Ok((index.digest(blob)?, length, file_of_index(index, blob, target)?))
    });
    named.collect()
}

/// The files of the blobs that an index names.
pub(super) fn blob_files_of_index(index: Vec<u8>) -> Result<BTreeSet<String>, Error> {
    let blobs = blobs_of_index(&file::from_bytes(index)?)?;
    Ok(blobs.into_iter().map(|(.., name)| name).collect())
}

/// The bytes of a blob's file, compared with its length and its checksum.
fn read_blob(folder: &Path, (hash, length, name): &NamedBlob) -> Result<Vec<u8>, Error> {
    let path = folder.join(BLOBS).join(name);
    let part = format!("{BLOBS}/{name}");
    let io = |error| Error::Io(format!("{part}: {error}"));
    let found = input::open_file(&path).and_then(|file| file.metadata()).map_err(io)?.len();
    if found != *length {
        let words = format!("it has {found} bytes, not {length}");
        return Err(Error::corrupt(part, words));
    }
    let bytes = input::read_file(&path, found.min(MOST_GROUP_BYTES as u64)).map_err(io)?;
    match to_hex(&checksum(&bytes)) == *hash {
        true => Ok(bytes),
        false => Err(Error::corrupt(part, "the checksum does not match")),
    }
}

/// How many blobs a thread reads at least.
const LEAST_PART: usize = 64;

/// Reads blobs, on several threads: most of the time is spent in opening files.
///
/// # Errors
/// That of the first blob which has one.
fn verify_blobs(folder: &Path, blobs: &[NamedBlob]) -> Result<(), Error> {
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let part = blobs.len().div_ceil(threads).max(LEAST_PART);
    let verify = |blobs: &[NamedBlob]| -> Result<(), Error> {
        blobs.iter().try_for_each(|blob| read_blob(folder, blob).map(drop))
    };
    std::thread::scope(|scope| {
        let start = |part| {
            let spawned = std::thread::Builder::new().spawn_scoped(scope, move || verify(part));
            // A system that gives no more threads does the work on this one.
            spawned.map_err(|_| part)
        };
        let works: Vec<_> = blobs.chunks(part).map(start).collect();
        works.into_iter().try_for_each(|work| match work {
            Ok(thread) => thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)),
            Err(part) => verify(part),
        })
    })
}

impl Store for Directory {
    fn programs(&self) -> &StoredPrograms {
        self.index.programs()
    }

    fn shard(&self) -> Option<&ShardOrigin> {
        self.index.shard()
    }

    fn find(&self, entry: usize, key: &str) -> Result<Option<u32>, Error> {
        self.index.find(entry, key)
    }

    fn each_key(&self, entry: usize, visit: &mut dyn FnMut(&str, u32)) -> Result<(), Error> {
        self.index.each_key(entry, visit)
    }

    fn unit(&self, unit: u32) -> Result<StoredUnit, Error> {
        self.index.unit(unit)
    }

    fn artifact(
        &self,
        unit: u32,
        target: &str,
    ) -> Result<(Arc<Reflection>, StoredArtifact), Error> {
        self.index.artifact(unit, target)
    }

    fn digest(&self, blob: u32) -> Result<String, Error> {
        self.index.digest(blob)
    }

    fn blob(&self, blob: u32) -> Result<Vec<u8>, Error> {
        let (hash, length) = (self.digest(blob)?, self.index.blob_record(blob)?.length as u64);
        read_blob(&self.path, &(hash, length, self.file_of(blob)?))
    }

    /// Refuses nothing. Each blob is read once, however many units name it, and no blob may be
    /// larger than a group, so the memory is in proportion to the bundle.
    fn measure(&self) -> Result<(), Error> {
        Ok(())
    }

    /// Checks what this reader has opened and what the folder has now. A run that was stopped has left
    /// the index of the next bundle beside the manifest of the one before, and both must be whole.
    fn verify(&self) -> Result<(), Error> {
        let index = input::read_file(&self.path.join(INDEX), MOST_MANIFEST_BYTES)
            .map_err(|error| Error::Io(format!("{INDEX}: {error}")))?;
        let mut blobs = blobs_of_index(&self.index)?;
        let of_manifest = pack_index(&read_manifest(&self.path)?)?;
        if of_manifest != index {
            blobs.extend(blobs_of_index(&file::from_bytes(of_manifest)?)?);
        }
        blobs.extend(blobs_of_index(&file::from_bytes(index)?)?);
        verify_blobs(&self.path, &blobs.into_iter().collect::<Vec<_>>())
    }

    fn pack(&self) -> Result<Vec<u8>, Error> {
        pack_outputs(&self.index, &|blob| self.blob(blob))
    }
}
