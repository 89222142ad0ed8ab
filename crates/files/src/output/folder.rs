//! Writes a folder of files without marks. A record beside them lists which ones are ours.

use std::collections::BTreeSet;
use std::fs::{self, File};
use std::io::ErrorKind;
use std::path::{Component, Path, PathBuf};

use super::file::{has_bytes, kind_of_entry};
use super::scratch::sync_folder;
use super::{Error, Foreign, Replace, Scratch, Turns, make_folder, rename_finished, wait_for_turn};

/// The record's name, and how it begins.
const RECORD: &str = ".lamplight-outputs";
const HEADER: &str = "# What `lamplight` wrote here, by hash and path. It replaces nothing else.\n";

/// The most bytes of a record, more than a folder of a million files needs.
const MOST_RECORD_BYTES: u64 = 256 << 20;

/// Writes files into a folder, each by its path below it. If one of them would replace something
/// that is not ours, nothing is written.
///
/// # Errors
/// [`Error::Foreign`] where something else is there.
pub fn write_folder<'a>(
    folder: &Path,
    files: impl IntoIterator<Item = (&'a str, &'a [u8])>,
    replace: Replace,
) -> Result<(), Error> {
    let files: Vec<(&str, &[u8])> = files.into_iter().collect();
    let mut folder = OutputFolder::open(folder, replace)?;
    for (name, bytes) in &files {
        folder.check(name, Some(bytes))?;
    }
    folder.note(&files)?;
    for (name, bytes) in &files {
        folder.put(name, bytes)?;
    }
    folder.finish()
}

/// An output folder that is written file by file.
pub struct OutputFolder {
    path: PathBuf,
    replace: Replace,
    /// The hash and path of each file that was written here. While a file is being replaced, its
    /// path has two hashes. So even if a run is killed, the next run knows every file.
    record: BTreeSet<(String, String)>,
    /// What this run wrote.
    written: BTreeSet<(String, String)>,
    scratch: Scratch,
    _turn: Option<File>,
}

impl OutputFolder {
    /// Makes the folder, or opens the one that is there.
    pub fn open(path: &Path, replace: Replace) -> Result<Self, Error> {
        make_folder(path)?;
        let turn = wait_for_turn(path, &Turns::default())?;
        Ok(Self {
            path: path.to_owned(),
            replace,
            record: read_record(path, replace)?,
            written: BTreeSet::new(),
            scratch: Scratch::new(path)?,
            _turn: turn,
        })
    }

    /// The folder, as the user named it.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Writes a file by its path below the folder.
    pub fn write(&mut self, name: &str, bytes: &[u8]) -> Result<(), Error> {
        self.check(name, Some(bytes))?;
        self.note(&[(name, bytes)])?;
        self.put(name, bytes)
    }

    /// Removes the older hashes of this run's files from the record.
    pub fn finish(mut self) -> Result<(), Error> {
        let names: BTreeSet<&str> = self.written.iter().map(|(_, name)| name.as_str()).collect();
        let before = self.record.len();
        let kept = |line: &(String, String)| {
            !names.contains(line.1.as_str()) || self.written.contains(line)
        };
        let record: BTreeSet<_> = self.record.iter().filter(|line| kept(line)).cloned().collect();
        self.record = record;
        if self.record.len() == before { Ok(()) } else { self.save() }
    }

    /// Fails if a file may not be written. If `bytes` are given, a file that already has them is
    /// fine.
    pub fn check(&self, name: &str, bytes: Option<&[u8]>) -> Result<(), Error> {
        let mut path = self.path.clone();
        let parts: Vec<Component> = Path::new(name).components().collect();
        for (index, part) in parts.iter().enumerate() {
            path.push(part);
            let found = match fs::symlink_metadata(&path) {
                Ok(found) => found,
                Err(error) if error.kind() == ErrorKind::NotFound => return Ok(()),
                Err(error) => return Err(Error::io(&path, &error)),
            };
            let is_last = index + 1 == parts.len();
            if !is_last && !found.is_dir() || is_last && !found.is_file() {
                return Err(Foreign::never(&path, kind_of_entry(found.file_type())).into());
            }
            if is_last && !self.may_replace(name, &path, found.len(), bytes)? {
                let found = "is a file that Lamplight did not write, or that was changed since";
                return Err(Foreign::file(&path, found).into());
            }
        }
        Ok(())
    }

    fn may_replace(
        &self,
        name: &str,
        path: &Path,
        length: u64,
        bytes: Option<&[u8]>,
    ) -> Result<bool, Error> {
        if self.replace == Replace::Any || length == 0 {
            return Ok(true);
        }
        if bytes.is_some_and(|bytes| has_bytes(path, length, bytes)) {
            return Ok(true);
        }
        if !self.record.iter().any(|(_, known)| known == name) {
            return Ok(false);
        }
        let found = fs::read(path).map_err(|error| Error::io(path, &error))?;
        Ok(self.record.contains(&record_line(name, &found)))
    }

    /// Records files that are about to be written.
    fn note(&mut self, files: &[(&str, &[u8])]) -> Result<(), Error> {
        let before = self.record.len();
        for (name, bytes) in files {
            let line = record_line(name, bytes);
            self.record.insert(line.clone());
            self.written.insert(line);
        }
        if self.record.len() == before { Ok(()) } else { self.save() }
    }

    fn put(&self, name: &str, bytes: &[u8]) -> Result<(), Error> {
        let path = self.path.join(name);
        let found = fs::symlink_metadata(&path);
        if found.is_ok_and(|found| has_bytes(&path, found.len(), bytes)) {
            return Ok(());
        }
        let folder = path.parent().unwrap_or(&self.path);
        make_folder(folder)?;
        let written = self.scratch.write("file", bytes)?;
        rename_finished(&written, &path).map_err(|error| Error::io(&path, &error))?;
        sync_folder(folder);
        Ok(())
    }

    fn save(&self) -> Result<(), Error> {
        let lines = self.record.iter().filter(|(_, name)| !name.contains(['\n', '\r']));
        let lines = lines.map(|(hash, name)| format!("{hash} {name}\n"));
        let mut lines: Vec<String> = lines.collect();
        // Sorted by path, so that a changed file changes only its own line.
        lines.sort_by(|a, b| a.split_once(' ').map(|a| a.1).cmp(&b.split_once(' ').map(|b| b.1)));
        let path = self.path.join(RECORD);
        let written =
            self.scratch.write("record", (HEADER.to_owned() + &lines.concat()).as_bytes())?;
        rename_finished(&written, &path).map_err(|error| Error::io(&path, &error))?;
        // The record is on the disk before any file that it lists.
        sync_folder(&self.path);
        Ok(())
    }
}

fn record_line(name: &str, bytes: &[u8]) -> (String, String) {
    (blake3::hash(bytes).to_hex().to_string(), name.to_owned())
}

fn read_record(folder: &Path, replace: Replace) -> Result<BTreeSet<(String, String)>, Error> {
    let path = folder.join(RECORD);
    let found = match fs::symlink_metadata(&path) {
        Ok(found) => found,
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(BTreeSet::new()),
        Err(error) => return Err(Error::io(&path, &error)),
    };
    if !found.is_file() {
        return Err(Foreign::never(&path, kind_of_entry(found.file_type())).into());
    }
    let text = match found.len() {
        0..=MOST_RECORD_BYTES => fs::read(&path).map_err(|error| Error::io(&path, &error))?,
        _ => Vec::new(),
    };
    let text = String::from_utf8_lossy(&text);
    match text.strip_prefix(HEADER) {
        Some(lines) => Ok(lines
            .lines()
            .filter_map(|line| line.split_once(' '))
            .map(|(hash, name)| (hash.to_owned(), name.to_owned()))
            .collect()),
        None if replace == Replace::Any || found.len() == 0 => Ok(BTreeSet::new()),
        None => Err(Foreign::file(&path, "is a file that Lamplight did not write").into()),
    }
}
