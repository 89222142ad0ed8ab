//! A cache in a folder.

use std::fs::{self, File};
use std::io::{ErrorKind, Read};
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

use super::{KINDS, Storage, record};
use lamplight_files::input;
use lamplight_files::output::{self, Foreign, Scratch};

/// The tag tells backup programs what the folder is, and shows the next run that the folder is
/// ours.
const TAG_FILE: &str = "CACHEDIR.TAG";
const TAG: &[u8] = b"Signature: 8a477f597d28d172789f06886806bc55\n\
    # This folder is a cache of lamplight. It may be deleted at any time.\n";

/// A folder with a file for each name. May be deleted at any time; several processes may share it.
#[derive(Debug, Clone)]
pub struct CacheFolder {
    path: PathBuf,
    /// The scratch folder, made before the first write.
    scratch: Arc<OnceLock<Result<Scratch, String>>>,
}

impl CacheFolder {
    /// Opens the folder. It is made when something is first put into it.
    ///
    /// # Errors
    /// If the path is something other than a cache.
    pub fn new(path: impl Into<PathBuf>) -> Result<Self, Foreign> {
        let path = path.into();
        let is_ours = |found: &fs::DirEntry| {
            found.file_name().to_str().is_some_and(|name| {
                name == TAG_FILE || name.starts_with(".lamplight-") || KINDS.contains(&name)
            })
        };
        let entries: Vec<fs::DirEntry> = match fs::read_dir(&path) {
            Ok(entries) => entries.flatten().collect(),
            Err(error) if error.kind() == ErrorKind::NotADirectory => {
                return Err(Foreign::never(&path, "is not a folder"));
            }
            Err(_) => Vec::new(),
        };
        let is_tagged = input::read_file(&path.join(TAG_FILE), TAG.len() as u64)
            .is_ok_and(|found| found == TAG);
        match entries.iter().find(|found| !is_tagged && !is_ours(found)) {
            Some(found) => {
                let found = found.file_name();
                let found = format!("has `{}` in it and is not a cache", found.to_string_lossy());
                Err(Foreign::never(&path, found))
            }
            None => Ok(Self { path, scratch: Arc::default() }),
        }
    }

    /// Opens the folder as a store, the cache that machines share.
    ///
    /// # Errors
    /// If the path is something other than a cache.
    pub fn open_store(path: &str) -> Result<Box<dyn Storage>, String> {
        Self::new(path)
            .map(|folder| Box::new(folder) as Box<dyn Storage>)
            .map_err(|foreign| foreign.to_string())
    }

    fn scratch(&self) -> Result<&Scratch, String> {
        let make = || {
            let scratch = output::make_folder(&self.path)
                .and_then(|()| Scratch::new(&self.path))
                .map_err(|error| error.to_string())?;
            if !self.path.join(TAG_FILE).exists() {
                self.put_file(&scratch, &self.path.join(TAG_FILE), TAG)?;
            }
            Ok(scratch)
        };
        self.scratch.get_or_init(make).as_ref().map_err(String::clone)
    }

    fn put_file(&self, scratch: &Scratch, path: &Path, bytes: &[u8]) -> Result<(), String> {
        let written = scratch.write_unsynced(bytes).map_err(|error| error.to_string())?;
        output::rename_finished(&written, path).map_err(|error| {
            let _ = fs::remove_file(&written);
            error.to_string()
        })
    }

    /// Makes the folders of a name. None of them may be a link.
    fn make_folders(&self, name: &str) -> Result<(), String> {
        let mut folder = self.path.clone();
        for part in Path::new(name).parent().into_iter().flat_map(Path::components) {
            folder.push(part);
            match fs::symlink_metadata(&folder) {
                Ok(found) if found.is_dir() => {}
                Ok(_) => return Err(format!("`{}` is not a folder", folder.display())),
                Err(_) => match fs::create_dir(&folder) {
                    Err(error) if error.kind() != ErrorKind::AlreadyExists => {
                        return Err(error.to_string());
                    }
                    _ => {}
                },
            }
        }
        Ok(())
    }
}

impl Storage for CacheFolder {
    fn get(&self, name: &str) -> Result<Option<Vec<u8>>, String> {
        let path = self.path.join(name);
        match fs::symlink_metadata(&path) {
            Ok(found) if found.is_file() => {}
            Ok(_) => return Err(format!("`{}` is not a file", path.display())),
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
            Err(error) => return Err(error.to_string()),
        }
        match input::read_file(&path, record::MOST_RECORD_BYTES) {
            Ok(bytes) => Ok(Some(bytes)),
            Err(error) if error.kind() == ErrorKind::NotFound => Ok(None),
            Err(error) => Err(error.to_string()),
        }
    }

    fn put(&self, name: &str, bytes: &[u8]) -> Result<(), String> {
        let path = self.path.join(name);
        let scratch = self.scratch()?;
        self.make_folders(name)?;
        if let Ok(found) = fs::symlink_metadata(&path)
            && (!found.is_file() || found.len() > 0 && !is_record(&path))
        {
            return Err(format!("`{}` is not a record of a cache", path.display()));
        }
        self.put_file(scratch, &path, bytes)
    }
}

/// Whether a file begins as a record does.
fn is_record(path: &Path) -> bool {
    let mut head = [0; record::MAGIC.len()];
    File::open(path).and_then(|mut file| file.read_exact(&mut head)).is_ok()
        && head == *record::MAGIC
}
