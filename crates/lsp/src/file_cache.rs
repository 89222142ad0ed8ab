//! A cache of the files on the disk. A text is valid while its file is as it was when it was read.
//! A keystroke asks for every file of a package, and asking the system whether a file has changed
//! takes a fifth of reading it.

use std::collections::HashMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, SystemTime};

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

/// Texts by path.
#[derive(Debug, Default)]
pub struct FileCache(Mutex<HashMap<PathBuf, (Stamp, String)>>);

impl FileCache {
    /// The cached text of a file if the file has not changed, or else the result of `read`.
    pub fn or_read<E>(
        &self,
        path: &Path,
        read: impl FnOnce() -> Result<Option<String>, E>,
    ) -> Result<Option<String>, E> {
        let stamp = stamp_of(path);
        let mut known = self.0.lock().unwrap_or_else(PoisonError::into_inner);
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
