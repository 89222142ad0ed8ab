//! Syncs files to the disk on Linux.

use std::fs::File;
use std::io;
use std::path::Path;

/// Fewer files than this are synced one by one, since syncing a whole file system also waits for
/// what other programs have written.
const MANY: usize = 64;

/// Returns when the files of a folder are on the disk.
///
/// Many files are synced by one call of `syncfs`, which writes all unwritten data of the file
/// system that the folder is on. So there is one wait instead of one for each file.
pub fn files(folder: &Path, names: &[&str]) -> io::Result<()> {
    if names.len() >= MANY {
        return Ok(rustix::fs::syncfs(File::open(folder)?)?);
    }
    names.iter().try_for_each(|name| File::open(folder.join(name))?.sync_all())
}
