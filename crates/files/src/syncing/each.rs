//! Syncs files to the disk one by one, on systems that have no call to sync many at once.

use std::fs::File;
use std::io;
use std::path::Path;

/// Returns when the files of a folder are on the disk.
pub fn files(folder: &Path, names: &[&str]) -> io::Result<()> {
    // Windows syncs only what is open for writing.
    let open = |name: &str| File::options().append(true).open(folder.join(name));
    names.iter().try_for_each(|name| open(name)?.sync_all())
}
