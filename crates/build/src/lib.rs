//! Tables of files for build scripts: adding a diagnostic, a target, a validator, an executor, a
//! reference or a scene is adding a file, and the build finds it.
//!
//! A build script calls one function and writes its text with [`write_table`].

#![allow(clippy::print_stdout)]

pub mod identity;

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::{env, fs, io};

/// The folder of the package that is built.
///
/// # Errors
/// No build script is running.
pub fn package_folder() -> io::Result<PathBuf> {
    env::var_os("CARGO_MANIFEST_DIR")
        .map(PathBuf::from)
        .ok_or_else(|| missing("CARGO_MANIFEST_DIR"))
}

/// Writes a text into the folder of the build's outputs, where `include!` finds it.
///
/// # Errors
/// No build script is running, or the file cannot be written.
pub fn write_table(name: &str, text: &str) -> io::Result<()> {
    let out = env::var_os("OUT_DIR").map(PathBuf::from).ok_or_else(|| missing("OUT_DIR"))?;
    fs::write(out.join(name), text)
}

fn missing(variable: &str) -> io::Error {
    io::Error::other(format!("cargo did not set {variable}: this runs in build scripts only"))
}

/// The files of a folder with an extension, sorted by name. Cargo watches the folder.
///
/// # Errors
/// The folder cannot be read.
pub fn files(folder: &Path, extension: &str) -> io::Result<Vec<PathBuf>> {
    println!("cargo::rerun-if-changed={}", folder.display());
    let mut found: Vec<PathBuf> = fs::read_dir(folder)?
        .map(|entry| entry.map(|entry| entry.path()))
        .collect::<Result<_, _>>()?;
    found.retain(|path| path.extension().is_some_and(|found| found == extension));
    found.sort();
    Ok(found)
}

/// The name of a file without its extension.
pub fn stem(path: &Path) -> String {
    path.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

/// Declares each Rust file of `folder`, which is below the package, as a module. `ALL` lists the
/// item `constant` of each, which has the type `ty`. Only files for which `is_wanted` are declared.
///
/// # Errors
/// The folder or a file cannot be read.
pub fn modules(
    folder: &str,
    constant: &str,
    ty: &str,
    is_wanted: fn(&Path) -> io::Result<bool>,
) -> io::Result<String> {
    let (mut table, mut entries) = (String::new(), String::new());
    for path in files(&package_folder()?.join(folder), "rs")? {
        if !is_wanted(&path)? {
            continue;
        }
        let name = stem(&path);
        let _ = writeln!(table, "#[path = {path:?}]\npub mod {name};");
        let _ = write!(entries, "&{name}::{constant}, ");
    }
    let _ = writeln!(
        table,
        "/// One entry for each file of the folder, by name.\npub const ALL: &[&{ty}] = &[{entries}];"
    );
    Ok(table)
}

/// The version of a dependency in the lock file of the workspace that is built, which need not be
/// that of this package; empty where there is none.
///
/// # Errors
/// No build script is running, or the lock file cannot be read.
pub fn locked_version(name: &str) -> io::Result<String> {
    let out = env::var_os("OUT_DIR").map(PathBuf::from).ok_or_else(|| missing("OUT_DIR"))?;
    let folder = package_folder()?;
    let mut folders = out.ancestors().chain(folder.ancestors());
    let Some(lock) =
        folders.find_map(|folder| Some(folder.join("Cargo.lock")).filter(|lock| lock.is_file()))
    else {
        return Ok(String::new());
    };
    println!("cargo::rerun-if-changed={}", lock.display());
    let text = fs::read_to_string(lock)?;
    let (_, after) =
        text.split_once(&format!("name = \"{name}\"\nversion = \"")).unwrap_or_default();
    Ok(after.split('"').next().unwrap_or_default().to_owned())
}

/// Every file is wanted.
///
/// # Errors
/// None.
pub fn every_file(_file: &Path) -> io::Result<bool> {
    Ok(true)
}
