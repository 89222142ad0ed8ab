//! Runs that write into one folder do so one after the other.

use std::fs::{File, TryLockError};
use std::io::ErrorKind;
use std::path::Path;
use std::time::{Duration, Instant};

use super::Error;

/// How to wait for the turn of this run.
pub struct Turns<'a> {
    /// Called once if another run writes there, with the number of its process if that is known.
    pub waiting: &'a dyn Fn(Option<u32>),
    /// How long to wait at most. A process that was stopped never ends its turn.
    pub most: Duration,
}

impl Default for Turns<'_> {
    fn default() -> Self {
        Self { waiting: &|_| (), most: Self::MOST }
    }
}

impl Turns<'_> {
    /// The default wait: longer than a run on a slow machine takes.
    pub const MOST: Duration = Duration::from_secs(600);
}

/// How often to try again.
const PAUSE: Duration = Duration::from_millis(20);

/// Waits until no other run writes into a folder.
///
/// A turn ends at the latest with its process. Where folders cannot be locked, runs do not wait for
/// each other.
///
/// # Errors
/// The other run does not end in time.
pub fn wait_for_turn(path: &Path, turns: &Turns<'_>) -> Result<Option<File>, Error> {
    let Ok(folder) = File::open(path) else { return Ok(None) };
    let start = Instant::now();
    let mut is_notified = false;
    loop {
        match folder.try_lock() {
            Ok(()) => return Ok(Some(folder)),
            Err(TryLockError::Error(_)) => return Ok(None),
            Err(TryLockError::WouldBlock) => {}
        }
        if !std::mem::replace(&mut is_notified, true) {
            (turns.waiting)(holder_of(&folder));
        }
        if start.elapsed() >= turns.most {
            return Err(too_long(path, &folder, turns.most));
        }
        std::thread::sleep(PAUSE.min(turns.most));
    }
}

fn too_long(path: &Path, folder: &File, most: Duration) -> Error {
    let who = match holder_of(folder) {
        Some(process) => format!("process {process} writes there"),
        None => "another process writes there".to_owned(),
    };
    let reason = format!("{who}, and did not finish within {} s", most.as_secs());
    Error::Io { path: path.to_owned(), kind: ErrorKind::TimedOut, reason }
}

/// The process that holds the lock of a folder, where the system lists locks: Linux.
#[cfg(target_os = "linux")]
fn holder_of(folder: &File) -> Option<u32> {
    use std::os::linux::fs::MetadataExt;
    let inode = folder.metadata().ok()?.st_ino().to_string();
    let locks = std::fs::read_to_string("/proc/locks").ok()?;
    // `1: FLOCK  ADVISORY  WRITE 4242 fe:00:1234 0 EOF`, and `1: -> FLOCK ...` for who waits.
    locks.lines().find_map(|line| {
        let words: Vec<&str> = line.split_whitespace().collect();
        let [_, "FLOCK", _, _, process, place, ..] = words.as_slice() else { return None };
        let found = place.rsplit(':').next()? == inode;
        process.parse().ok().filter(|process| found && *process > 0)
    })
}

#[cfg(not(target_os = "linux"))]
fn holder_of(_: &File) -> Option<u32> {
    None
}
