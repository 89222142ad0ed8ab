//! Waits for the disk on Linux.

use std::fs::File;
use std::io;
use std::path::Path;

/// Fewer files than this are waited for one by one: what other programs write is not waited for.
const MANY: usize = 64;

/// Returns when the files of a folder are on the disk.
///
/// Many files cost one wait instead of one each: the system is asked for all that is not written
/// yet of the disk that the folder is on.
pub fn files(folder: &Path, names: &[&str]) -> io::Result<()> {
    if names.len() >= MANY {
        return Ok(rustix::fs::syncfs(File::open(folder)?)?);
    }
    names.iter().try_for_each(|name| File::open(folder.join(name))?.sync_all())
}
