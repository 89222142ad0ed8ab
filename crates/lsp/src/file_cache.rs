//! A cache of the files on the disk and of what folders have. A text is valid while its file is as
//! it was when it was read.
//! A keystroke asks for every file of a package, and asking the system whether a file has changed
//! takes a fifth of reading it.

use std::collections::HashMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant, SystemTime};

/// File systems count the time of a change in steps of at most so long. A file that was read right
/// after it changed may have changed again in the same step.
const STEP: Duration = Duration::from_secs(2);

/// Texts that are kept at most; with more, all are forgotten.
const FILES: usize = 1 << 14;

/// The metadata by which a change of a file is noticed without reading it.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Stamp {
    bytes: u64,
    modified: SystemTime,
    created: Option<SystemTime>,
}

/// How long the files of a folder are taken to be the same, unless the editor tells of a change.
/// Every key of a text with a broken import asks for them.
const LISTED: Duration = Duration::from_secs(1);

/// The files of a folder with some extensions, and when they were listed.
type Listings = HashMap<(String, String), (Instant, Vec<String>)>;

/// Texts by path, and files by folder.
#[derive(Debug, Default)]
pub struct FileCache {
    texts: Mutex<HashMap<PathBuf, (Stamp, String)>>,
    listings: Mutex<Listings>,
}

impl FileCache {
    /// The files of a folder as they were listed shortly before, or else the result of `list`.
    pub fn or_list(
        &self,
        folder: String,
        extensions: &[&str],
        list: impl FnOnce() -> Vec<String>,
    ) -> Vec<String> {
        let mut known = self.listings.lock().unwrap_or_else(PoisonError::into_inner);
        let key = (folder, extensions.join(" "));
        if let Some((then, files)) = known.get(&key)
            && then.elapsed() < LISTED
        {
            return files.clone();
        }
        let files = list();
        // From the end of the listing on: a large folder takes long.
        known.insert(key, (Instant::now(), files.clone()));
        files
    }

    /// Has folders listed anew, after files were made or removed.
    pub fn forget_listings(&self) {
        self.listings.lock().unwrap_or_else(PoisonError::into_inner).clear();
    }

    /// The cached text of a file if the file has not changed, or else the result of `read`.
    pub fn or_read<E>(
        &self,
        path: &Path,
        read: impl FnOnce() -> Result<Option<String>, E>,
    ) -> Result<Option<String>, E> {
        let stamp = stamp_of(path);
        let mut known = self.texts.lock().unwrap_or_else(PoisonError::into_inner);
        if let (Some(stamp), Some((then, text))) = (&stamp, known.get(path))
            && then == stamp
        {
            return Ok(Some(text.clone()));
        }
        let now = SystemTime::now();
        let text = read()?;
        known.remove(path);
        if let (Some(stamp), Some(text)) = (stamp, &text)
            && now.duration_since(stamp.modified).is_ok_and(|age| age > STEP)
        {
            if known.len() >= FILES {
                known.clear();
            }
            known.insert(path.to_owned(), (stamp, text.clone()));
        }
        Ok(text)
    }
}

fn stamp_of(path: &Path) -> Option<Stamp> {
    let found = fs::metadata(path).ok()?;
    let created = found.created().ok();
    Some(Stamp { bytes: found.len(), modified: found.modified().ok()?, created })
}
