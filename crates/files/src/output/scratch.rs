//! Folders for unfinished files.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::hash::{BuildHasher, Hasher, RandomState};
use std::io::{ErrorKind, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};

use super::Error;
use crate::syncing;

/// How the name of a scratch folder begins; sixteen random digits follow.
const PREFIX: &str = ".lamplight-";
const DIGITS: usize = 16;

/// The file that marks a folder as ours. The run that uses the folder holds a lock on it.
const MARK_FILE: &str = "mark";
const MARK: &[u8] = b"Lamplight: files of a run that is not over. Delete this folder if none is.\n";

/// How many names and locks are tried before giving up.
const TRIES: u32 = 32;

/// A folder beside the files to be written, which exists during one run.
///
/// Its name is random, and it is made by a call that follows no link and fails if anything is
/// there. So nobody can prepare a trap at its path. When it is made, folders of killed runs are
/// removed: those with our mark that no process holds.
#[derive(Debug)]
pub struct Scratch {
    folder: PathBuf,
    /// The lock, held until this is dropped.
    _mark: File,
    next: AtomicU32,
}

impl Scratch {
    /// Makes a folder in `parent`, which must exist.
    pub fn new(parent: &Path) -> Result<Self, Error> {
        Self::after(parent, &mut |_| ())
    }

    /// As [`Self::new`]; `look` is called with the folder of each killed run before it is removed.
    pub fn after(parent: &Path, look: &mut dyn FnMut(&Path)) -> Result<Self, Error> {
        for (folder, _mark) in left_folders(parent) {
            look(&folder);
            remove_scratch(&folder);
        }
        let mut last = None;
        for _ in 0..TRIES {
            let random = RandomState::new().build_hasher().finish();
            let folder = parent.join(format!("{PREFIX}{random:0DIGITS$x}"));
            match make_mark(&folder) {
                Ok(mark) => return Ok(Self { folder, _mark: mark, next: AtomicU32::new(0) }),
                // The folder is somebody else's, or another run removed it before its mark was
                // locked.
                Err(error)
                    if matches!(
                        error.kind(),
                        ErrorKind::AlreadyExists | ErrorKind::NotFound | ErrorKind::WouldBlock
                    ) && parent.is_dir() =>
                {
                    last = Some(error);
                }
                Err(error) => return Err(Error::io(parent, &error)),
            }
        }
        let error = last.unwrap_or_else(|| ErrorKind::AlreadyExists.into());
        Err(Error::io(parent, &error))
    }

    /// The path of a file in the folder.
    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.join(name)
    }

    /// Writes a file that must survive a loss of power once it is renamed.
    pub fn write(&self, name: &str, bytes: &[u8]) -> Result<PathBuf, Error> {
        self.write_with(name, |file| {
            file.write_all(bytes)?;
            file.sync_all()
        })
    }

    /// Writes a file without waiting for the disk: [`Self::sync`] waits for many at once.
    pub fn stage(&self, name: &str, bytes: &[u8]) -> Result<PathBuf, Error> {
        self.write_with(name, |file| file.write_all(bytes))
    }

    /// Returns when files of those names are on the disk.
    pub fn sync(&self, names: &[&str]) -> Result<(), Error> {
        syncing::files(&self.folder, names).map_err(|error| Error::io(&self.folder, &error))
    }

    /// Writes a file under a name of its own, without waiting for the disk. This is for what can be
    /// computed again.
    pub fn write_unsynced(&self, bytes: &[u8]) -> Result<PathBuf, Error> {
        self.stage(&self.next.fetch_add(1, Ordering::Relaxed).to_string(), bytes)
    }

    fn write_with(
        &self,
        name: &str,
        write: impl FnOnce(&mut File) -> std::io::Result<()>,
    ) -> Result<PathBuf, Error> {
        let path = self.path(name);
        let written = OpenOptions::new()
            .write(true)
            .create_new(true)
            .open(&path)
            .and_then(|mut file| write(&mut file));
        match written {
            Ok(()) => Ok(path),
            Err(error) => Err(Error::io(&path, &error)),
        }
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        remove_scratch(&self.folder);
    }
}

fn make_mark(folder: &Path) -> std::io::Result<File> {
    fs::create_dir(folder)?;
    let path = folder.join(MARK_FILE);
    let mut mark = OpenOptions::new().read(true).write(true).create_new(true).open(&path)?;
    if matches!(mark.try_lock(), Err(TryLockError::WouldBlock)) {
        return Err(ErrorKind::WouldBlock.into());
    }
    fs::symlink_metadata(&path)?;
    if let Err(error) = mark.write_all(MARK) {
        // Such as a full disk: nothing of this run stays.
        remove_scratch(folder);
        return Err(error);
    }
    Ok(mark)
}

/// Folders of runs that were killed, each with the lock on its mark.
fn left_folders(parent: &Path) -> Vec<(PathBuf, File)> {
    let named = |name: &str| {
        name.strip_prefix(PREFIX).is_some_and(|digits| {
            digits.len() == DIGITS
                && digits.bytes().all(|digit| matches!(digit, b'0'..=b'9' | b'a'..=b'f'))
        })
    };
    let mut found = Vec::new();
    for entry in fs::read_dir(parent).into_iter().flatten().flatten() {
        let is_folder = entry.file_type().is_ok_and(|kind| kind.is_dir());
        if is_folder && entry.file_name().to_str().is_some_and(named) {
            let folder = entry.path();
            match dead_mark(&folder.join(MARK_FILE)) {
                Some(mark) => found.push((folder, mark)),
                // A run was killed before it wrote its mark. The folder is removed only if it is
                // empty.
                None => drop(fs::remove_dir(&folder)),
            }
        }
    }
    found
}

/// The mark of a scratch folder, locked. `None` if a run holds it, or if it is not our mark.
fn dead_mark(path: &Path) -> Option<File> {
    if !fs::symlink_metadata(path).ok()?.is_file() {
        return None;
    }
    let mut mark = OpenOptions::new().read(true).write(true).open(path).ok()?;
    mark.try_lock().ok()?;
    let mut text = Vec::new();
    (&mut mark).take(MARK.len() as u64 + 1).read_to_end(&mut text).ok()?;
    MARK.starts_with(&text).then_some(mark)
}

/// Removes a scratch folder, its mark last. Anything that is not a file stays, and so does the
/// folder then.
fn remove_scratch(folder: &Path) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let is_file = entry.file_type().is_ok_and(|kind| kind.is_file());
        if is_file && entry.file_name() != MARK_FILE {
            let _ = fs::remove_file(entry.path());
        }
    }
    let _ = fs::remove_file(folder.join(MARK_FILE));
    let _ = fs::remove_dir(folder);
}

/// Makes renames within a folder survive a loss of power, if the system can.
pub fn sync_folder(folder: &Path) {
    if let Ok(folder) = File::open(folder) {
        let _ = folder.sync_all();
    }
}
