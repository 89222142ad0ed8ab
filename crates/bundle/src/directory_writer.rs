//! Writes the directory form.
//!
//! A run collects its blobs in a scratch folder inside the directory. When all are there and
//! synced, they are renamed into `blobs/`. Then one rename puts the index into its place,
//! and another one the manifest. So whenever the run is killed, the directory holds either the old
//! bundle or the new one, complete; between the two renames, the index already names the new one,
//! all of whose blobs are there. If the run is killed there, the blobs of both stay until a later run
//! has put an index and a manifest of its own into their places.
//!
//! A program that has the older bundle open can go on reading it: its blobs are listed in
//! [`RETIRED`] and stay until the next run. Only blobs that a manifest or an index of ours names are
//! ever removed.

use std::collections::BTreeSet;
use std::fs::{self, File};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use super::directory::{
    BLOBS, BlobFile, INDEX, MANIFEST, MOST_MANIFEST_BYTES, blob_files_of_index,
    blob_files_of_manifest, read_manifest,
};
use super::layout::MAGIC;
use super::manifest::{self, Before, Manifest, ManifestArtifact};
use super::pack::{newer_bundle, pack_index};
use super::staging::add_unit;
use super::{Contents, Digest, Digester, Error, Unit};
use lamplight_files::output::{self, Foreign, Replace, Scratch, Turns};

/// The file that lists the blobs that only the bundle before this one has, one on each line.
const RETIRED: &str = ".lamplight-retired";
const RETIRED_HEADER: &str =
    "# Blobs of the bundle that was here before this one. The next run removes them.\n";

/// Writes the directory form, and replaces a bundle of ours that is there.
pub fn write_directory(contents: &Contents, path: impl AsRef<Path>) -> Result<(), Error> {
    let writer = DirectoryWriter::create(path)?;
    writer.add_all(contents)?;
    writer.finish(contents)
}

/// Writes the directory form unit by unit, and replaces a bundle of ours that is there. Only the
/// manifest is kept in memory.
#[derive(Debug)]
pub struct DirectoryWriter {
    path: PathBuf,
    replace: Replace,
    /// Files of blobs that the present manifest or the present index names.
    live: BTreeSet<String>,
    /// Files of blobs that only the bundle before them named.
    retired: BTreeSet<String>,
    scratch: Scratch,
    digester: Digester,
    manifest: Mutex<Manifest>,
    /// Files of blobs in the scratch folder.
    staged: Mutex<BTreeSet<String>>,
    /// A lock that makes other runs wait. It is held until the writer is dropped.
    _turn: Option<File>,
}

impl DirectoryWriter {
    /// Begins a new bundle at `path`. A bundle that is there does not change until
    /// [`Self::finish`].
    ///
    /// # Errors
    /// [`Error::Foreign`] where `path` has files but no bundle of ours.
    pub fn create(path: impl AsRef<Path>) -> Result<Self, Error> {
        Self::take_over(path, Replace::Ours, &Turns::default())
    }

    /// As [`Self::create`], but replaces what `replace` allows, and waits for another run that
    /// writes there as `turns` says.
    pub fn take_over(
        path: impl AsRef<Path>,
        replace: Replace,
        turns: &Turns<'_>,
    ) -> Result<Self, Error> {
        let path = path.as_ref();
        output::make_folder(path)?;
        let turn = output::wait_for_turn(path, turns)?;
        let before = survey_manifest(path, replace)?;
        let is_ours = before.is_some();
        let mut live = before.unwrap_or_default();
        live.extend(survey_index(path, replace)?);
        let retired = read_retired(path, replace)?;
        let blobs = path.join(BLOBS);
        let has_blobs = is_folder(&blobs)?;
        let mut look = |left: &Path| remove_unfinished(left, &blobs, [&live, &retired]);
        let scratch = Scratch::after(path, &mut look)?;
        if !is_ours && retired.is_empty() && replace == Replace::Ours {
            survey_foreign_files(path, &scratch, has_blobs)?;
        }
        Ok(Self {
            path: path.to_owned(),
            replace,
            live,
            retired,
            scratch,
            digester: Digester::default(),
            manifest: Mutex::default(),
            staged: Mutex::default(),
            _turn: turn,
        })
    }

    /// Continues the bundle at `path`.
    pub(super) fn reopen(path: impl AsRef<Path>) -> Result<Self, Error> {
        let writer = Self::create(path)?;
        let manifest = read_manifest(&writer.path)?;
        Ok(Self { manifest: Mutex::new(manifest), ..writer })
    }

    /// Keeps the blobs of a unit for [`Self::finish`]; keys refer to it by the digest's hash.
    pub fn add(&self, unit: &Unit) -> Result<Digest, Error> {
        let (digest, part) =
            add_unit(&self.digester, unit, &mut |name, bytes| self.stage(name, bytes))?;
        self.manifest().absorb(part);
        Ok(digest)
    }

    /// Keeps the blobs of all units.
    pub(super) fn add_all(&self, contents: &Contents) -> Result<(), Error> {
        let mut units = contents.entries().flat_map(|entry| entry.units.values());
        units.try_for_each(|unit| self.add(unit).map(drop))
    }

    /// Writes a blob to the scratch folder, unless the directory has it already.
    fn stage(&self, name: String, bytes: &[u8]) -> Result<(), Error> {
        let place = self.path.join(BLOBS).join(&name);
        let found = fs::symlink_metadata(&place).ok();
        let is_there = found.is_some_and(|found| {
            found.is_file()
                && found.len() == bytes.len() as u64
                && fs::read(&place).is_ok_and(|found| found == bytes)
        });
        let mut staged = self.staged.lock().unwrap_or_else(PoisonError::into_inner);
        if is_there || !staged.insert(name.clone()) {
            return Ok(());
        }
        drop(staged);
        self.scratch.stage(&name, bytes)?;
        Ok(())
    }

    /// The blobs of all units so far, where they are now: in the scratch folder, or already in
    /// `blobs/`. So they can be looked at before [`Self::finish`].
    pub fn blob_files(&self) -> Result<BTreeSet<BlobFile>, Error> {
        let staged = self.staged.lock().unwrap_or_else(PoisonError::into_inner);
        let place = |name: &str| match staged.contains(name) {
            true => self.scratch.path(name),
            false => self.path.join(BLOBS).join(name),
        };
        blob_files_of_manifest(&self.manifest(), &place)
    }

    /// Writes the manifest for the programs and keys of `contents`; units in `contents` are
    /// ignored. Blobs that the manifest does not name are removed by the next run.
    ///
    /// # Errors
    /// [`Error::Corrupt`] where a key refers to a unit that was not added.
    pub fn finish(self, contents: &Contents) -> Result<(), Error> {
        let mut manifest = std::mem::take(&mut *self.manifest());
        manifest.outline(contents)?;
        self.publish(manifest)
    }

    /// Sets the keys of `contents`, and leaves all others as they are.
    pub(super) fn patch(self, contents: &Contents) -> Result<(), Error> {
        let mut manifest = std::mem::take(&mut *self.manifest());
        let mut others = std::mem::take(&mut manifest.programs);
        manifest.outline(contents)?;
        let patches = std::mem::take(&mut manifest.programs);
        for (name, patch) in patches {
            let program = others.entry(name).or_default();
            program.axes = patch.axes;
            for (language, entries) in patch.entries {
                let known = program.entries.entry(language).or_default();
                for (entry, patch) in entries {
                    known.entry(entry).or_default().keys.extend(patch.keys);
                }
            }
        }
        manifest.programs = others;
        self.publish(manifest)
    }

    /// Puts the blobs and the manifest in place. Each step leaves the older bundle complete. If a
    /// run is killed, the manifest in its scratch folder tells the next run which blobs may have
    /// been moved already.
    fn publish(&self, mut manifest: Manifest) -> Result<(), Error> {
        manifest.complete()?;
        let artifacts = manifest.units.values().flat_map(|unit| unit.targets.values());
        let next = artifacts.map(ManifestArtifact::file).collect::<Result<BTreeSet<_>, _>>()?;
        let mut text = Vec::new();
        manifest::write_manifest(&manifest, &mut text)?;
        let place = self.path.join(MANIFEST);
        let index = pack_index(&manifest)?;
        let is_same = fs::read(&place).is_ok_and(|found| found == text)
            && fs::read(self.path.join(INDEX)).is_ok_and(|found| found == index);
        let staged = self.staged.lock().unwrap_or_else(PoisonError::into_inner);
        self.check_blobs(&staged)?;
        // The blobs are synced before a manifest names them. So a loss of power cannot leave a
        // manifest whose blobs are missing.
        self.scratch.sync(&staged.iter().map(String::as_str).collect::<Vec<_>>())?;
        let written = [
            (self.scratch.write(INDEX, &index)?, self.path.join(INDEX)),
            (self.scratch.write(MANIFEST, &text)?, place),
        ];
        self.remove_retired(&next);
        self.move_blobs(&staged)?;
        self.write_retired(self.live.difference(&next))?;
        if !is_same {
            for (written, place) in written {
                output::rename_finished(&written, &place)
                    .map_err(|error| io_error(&place, &error))?;
            }
            output::sync_folder(&self.path);
        }
        Ok(())
    }

    /// Refuses to replace a file of somebody else by a blob.
    fn check_blobs(&self, staged: &BTreeSet<String>) -> Result<(), Error> {
        let blobs = self.path.join(BLOBS);
        is_folder(&blobs)?;
        for name in staged {
            let place = blobs.join(name);
            let Ok(found) = fs::symlink_metadata(&place) else { continue };
            let is_ours = self.live.contains(name) || self.retired.contains(name);
            if !found.is_file() {
                return Err(Error::Foreign(Foreign::never(&place, "is not a file")));
            }
            if !is_ours && self.replace == Replace::Ours {
                return Err(Error::Foreign(foreign_file(&place)));
            }
        }
        Ok(())
    }

    fn move_blobs(&self, staged: &BTreeSet<String>) -> Result<(), Error> {
        let blobs = self.path.join(BLOBS);
        fs::create_dir_all(&blobs).map_err(|error| io_error(&blobs, &error))?;
        for name in staged {
            let place = blobs.join(name);
            output::rename_finished(&self.scratch.path(name), &place)
                .map_err(|error| io_error(&place, &error))?;
        }
        output::sync_folder(&blobs);
        Ok(())
    }

    /// Removes the blobs that only the bundle before the present one has, except those in `next`.
    fn remove_retired(&self, next: &BTreeSet<String>) {
        for name in self.retired.difference(next).filter(|name| !self.live.contains(*name)) {
            remove_blob(&self.path.join(BLOBS).join(name));
        }
    }

    fn write_retired<'a>(&self, names: impl Iterator<Item = &'a String>) -> Result<(), Error> {
        let place = self.path.join(RETIRED);
        let lines: String = names.flat_map(|name| [name.as_str(), "\n"]).collect();
        if !lines.is_empty() {
            let text = RETIRED_HEADER.to_owned() + &lines;
            let written = self.scratch.write(RETIRED, text.as_bytes())?;
            return output::rename_finished(&written, &place)
                .map_err(|error| io_error(&place, &error));
        }
        match fs::remove_file(&place) {
            Err(error) if error.kind() != ErrorKind::NotFound => Err(io_error(&place, &error)),
            _ => Ok(()),
        }
    }

    fn manifest(&self) -> MutexGuard<'_, Manifest> {
        // A thread that panicked here has not added its unit, so no key can name that.
        self.manifest.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

fn io_error(path: &Path, error: &std::io::Error) -> Error {
    output::Error::io(path, error).into()
}

fn foreign_file(path: &Path) -> Foreign {
    Foreign::file(path, "is a file that Lamplight did not write")
}

/// The blobs of the manifest that is there; `None` if there is none of ours. A manifest of ours
/// that cannot be read counts as one without blobs.
fn survey_manifest(path: &Path, replace: Replace) -> Result<Option<BTreeSet<String>>, Error> {
    let place = path.join(MANIFEST);
    let Some(text) = read_own(&place)? else { return Ok(None) };
    match manifest::kind_of_manifest(&text) {
        Before::Whole(files) => Ok(Some(files)),
        Before::Newer(version) if replace == Replace::Ours => {
            Err(Error::Foreign(Foreign::file(&place, newer_bundle(version))))
        }
        Before::Unreadable | Before::Newer(_) => Ok(Some(BTreeSet::new())),
        Before::Foreign if replace == Replace::Any || text.is_empty() => Ok(None),
        Before::Foreign => Err(Error::Foreign(foreign_file(&place))),
    }
}

/// The blobs of the index that is there. It is the index of another bundle than the manifest's where
/// a run was killed between the two. An index that is damaged counts as one without blobs.
///
/// # Errors
/// [`Error::Foreign`] for an index that is a link or no file, and for one of somebody else.
fn survey_index(path: &Path, replace: Replace) -> Result<BTreeSet<String>, Error> {
    let place = path.join(INDEX);
    match read_own(&place)? {
        None => Ok(BTreeSet::new()),
        Some(bytes)
            if replace == Replace::Ours && !bytes.is_empty() && !bytes.starts_with(MAGIC) =>
        {
            Err(Error::Foreign(foreign_file(&place)))
        }
        Some(bytes) => Ok(blob_files_of_index(bytes).unwrap_or_default()),
    }
}

fn read_retired(path: &Path, replace: Replace) -> Result<BTreeSet<String>, Error> {
    let place = path.join(RETIRED);
    let Some(text) = read_own(&place)? else { return Ok(BTreeSet::new()) };
    let text = String::from_utf8_lossy(&text);
    let is_name = |name: &&str| {
        let mut bytes = name.bytes();
        !name.starts_with('.') && bytes.all(|byte| byte == b'.' || byte.is_ascii_alphanumeric())
    };
    match text.strip_prefix(RETIRED_HEADER) {
        Some(lines) => Ok(lines.lines().filter(is_name).map(str::to_owned).collect()),
        None if replace == Replace::Any || text.is_empty() => Ok(BTreeSet::new()),
        None => Err(Error::Foreign(foreign_file(&place))),
    }
}

/// A file of the directory itself, which must be a file and not a link; `None` if there is none.
fn read_own(place: &Path) -> Result<Option<Vec<u8>>, Error> {
    match fs::symlink_metadata(place) {
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(None),
        Err(error) => Err(io_error(place, &error)),
        Ok(found) if !found.is_file() => {
            Err(Error::Foreign(Foreign::never(place, "is not a file")))
        }
        Ok(found) if found.len() > MOST_MANIFEST_BYTES => Err(Error::Foreign(foreign_file(place))),
        Ok(_) => fs::read(place).map(Some).map_err(|error| io_error(place, &error)),
    }
}

/// Whether a folder is there. A link to a folder is refused.
fn is_folder(place: &Path) -> Result<bool, Error> {
    match fs::symlink_metadata(place) {
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(false),
        Err(error) => Err(io_error(place, &error)),
        Ok(found) if found.is_dir() => Ok(true),
        Ok(found) if found.is_symlink() => Err(Error::Foreign(Foreign::never(
            place,
            "is a link, and blobs are neither written nor removed through links",
        ))),
        Ok(_) => Err(Error::Foreign(Foreign::never(place, "is not a folder"))),
    }
}

/// Refuses a folder that has something in it but no bundle of ours.
fn survey_foreign_files(path: &Path, scratch: &Scratch, has_blobs: bool) -> Result<(), Error> {
    let entries = |folder: &Path| {
        let entries = fs::read_dir(folder).map_err(|error| io_error(folder, &error))?;
        let mut names: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
        names.sort();
        Ok::<_, Error>(names)
    };
    let (own, blobs) = (scratch.path(""), path.join(BLOBS));
    let mut found: Vec<PathBuf> = entries(path)?;
    found.retain(|place| !own.starts_with(place) && *place != blobs);
    if has_blobs {
        found.extend(entries(&blobs)?);
    }
    let Some(first) = found.first() else { return Ok(()) };
    let first = first.strip_prefix(path).unwrap_or(first).display();
    let found = match found.len() {
        1 => format!("has `{first}` in it and no bundle"),
        count => format!("has {count} files or folders in it, such as `{first}`, and no bundle"),
    };
    Err(Error::Foreign(Foreign::file(path, found)))
}

/// Removes blobs that a killed run moved and that neither the manifest nor the index names. `left` is
/// the scratch folder that this run left.
fn remove_unfinished(left: &Path, blobs: &Path, known: [&BTreeSet<String>; 2]) {
    let Ok(Some(text)) = read_own(&left.join(MANIFEST)) else { return };
    let Before::Whole(files) = manifest::kind_of_manifest(&text) else { return };
    files
        .iter()
        .filter(|name| known.iter().all(|known| !known.contains(*name)))
        .for_each(|name| remove_blob(&blobs.join(name)));
}

/// Removes a blob. If that fails, the file only takes up space.
fn remove_blob(place: &Path) {
    if fs::symlink_metadata(place).is_ok_and(|found| found.is_file()) {
        let _ = fs::remove_file(place);
    }
}
