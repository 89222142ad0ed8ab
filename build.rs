//! Computes the identity of the build, which the caches of results depend on.

#![allow(clippy::print_stdout)]

use std::path::{Path, PathBuf};
use std::{env, fs, io};

fn main() -> io::Result<()> {
    let folder = |name| env::var_os(name).map(PathBuf::from).ok_or(io::ErrorKind::NotFound);
    let (root, out) = (folder("CARGO_MANIFEST_DIR")?, folder("OUT_DIR")?);
    // The lock file of the workspace that is built, which need not be this crate's.
    let mut folders = out.ancestors().chain([root.as_path()]);
    let lock = folders.find_map(|folder| fs::read(folder.join("Cargo.lock")).ok());
    let mut settings = vec![lock.unwrap_or_default()];
    for variable in ["CARGO_PKG_VERSION", "TARGET"] {
        settings.push(env::var(variable).unwrap_or_default().into_bytes());
    }
    // Machines of several kinds may share the work for one bundle.
    let version = env::var("CARGO_PKG_VERSION").unwrap_or_default();
    let tool = build_identity(&root, &settings[..2])?;
    println!("cargo::rustc-env=LAMPLIGHT_TOOL={version} {tool}");
    for folder in source_folders(&root)? {
        println!("cargo::rerun-if-changed={}", folder.display());
    }
    println!("cargo::rerun-if-changed={}", root.join("Cargo.lock").display());
    println!("cargo::rustc-env=LAMPLIGHT_BUILD={}", build_identity(&root, &settings)?);
    Ok(())
}

/// What results are computed by: the sources of this package, of the library, and of the packages
/// below `crates/`. A published package has none of the latter below it; their versions are in the
/// lock file.
fn source_folders(root: &Path) -> io::Result<Vec<PathBuf>> {
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
fn build_identity(root: &Path, settings: &[Vec<u8>]) -> io::Result<String> {
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
fn collect_files(path: &Path, files: &mut Vec<PathBuf>) -> io::Result<()> {
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
