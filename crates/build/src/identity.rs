//! The identity of a build: a hash of all that its results are computed by.

use std::path::{Path, PathBuf};
use std::{fs, io};

/// What results are computed by: the sources of the root package, of the library, and of the packages
/// below `crates/`. A published package has none of the latter below it; their versions are in the
/// lock file.
///
/// # Errors
/// A folder cannot be read.
pub fn source_folders(root: &Path) -> io::Result<Vec<PathBuf>> {
    let mut folders = vec![root.join("src"), root.join("shaderlib")];
    let crates = root.join("crates");
    if crates.is_dir() {
        for entry in fs::read_dir(crates)? {
            let folder = entry?.path();
            folders.extend(["src", "build.rs", "Cargo.toml"].map(|name| folder.join(name)));
        }
    }
    folders.retain(|folder| folder.exists());
    folders.sort();
    Ok(folders)
}

/// A hash of the settings and of every source file of the workspace.
///
/// # Errors
/// A file cannot be read.
pub fn build_identity(root: &Path, settings: &[Vec<u8>]) -> io::Result<String> {
    let mut hash = Fnv::default();
    settings.iter().for_each(|setting| hash.add(setting));
    let mut files = Vec::new();
    for folder in source_folders(root)? {
        collect_files(&folder, &mut files)?;
    }
    files.sort();
    for path in files {
        hash.add(
            path.strip_prefix(root)
                .unwrap_or(&path)
                .to_string_lossy()
                .replace('\\', "/")
                .as_bytes(),
        );
        hash.add(&fs::read(&path)?);
    }
    Ok(format!("{:032x}", hash.0))
}

/// A file, or every file below a folder.
///
/// # Errors
/// A folder cannot be read.
pub fn collect_files(path: &Path, files: &mut Vec<PathBuf>) -> io::Result<()> {
    if path.is_file() {
        files.push(path.to_owned());
        return Ok(());
    }
    fs::read_dir(path)?.try_for_each(|entry| collect_files(&entry?.path(), files))
}

/// FNV-1a of 128 bits: short enough to write down here, and build scripts should stay light.
struct Fnv(u128);

impl Default for Fnv {
    fn default() -> Self {
        Self(0x6c62_272e_07bb_0142_62b8_2175_6295_c58d)
    }
}

impl Fnv {
    fn add(&mut self, bytes: &[u8]) {
        for byte in (bytes.len() as u64).to_le_bytes().iter().chain(bytes) {
            self.0 = (self.0 ^ u128::from(*byte))
                .wrapping_mul(0x0000_0000_0100_0000_0000_0000_0000_013b);
        }
    }
}
