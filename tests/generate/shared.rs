//! Caches that several machines share: a folder, and the rules for every kind.

use std::fs;

use super::{Outcome, Package, compiled, equal};

pub fn shared_folder() -> Outcome {
    shared(&format!("fs:{}", tempfile::tempdir()?.path().display()))
}

/// A folder that has something else in it is no store, and nothing is written to it.
pub fn foreign_folder() -> Outcome {
    let (package, folder) = (Package::new()?, tempfile::tempdir()?);
    fs::write(folder.path().join("notes.txt"), "mine")?;
    let store = format!("fs:{}", folder.path().display());
    let refused = package.run(&["gen", "--cache", "cache", "--store", &store])?;
    equal(refused.status.code(), Some(4))?;
    equal(String::from_utf8_lossy(&refused.stderr).contains("`notes.txt`"), true)?;
    equal(fs::read_dir(folder.path())?.count(), 1)
}

/// Another machine, which has an empty cache, takes everything from the store and compiles nothing.
pub fn shared(store: &str) -> Outcome {
    let package = Package::new()?;
    package.generate(&["--store", store, "-o", "one"])?;
    fs::rename(package.path().join("cache"), package.path().join("cache of another machine"))?;
    equal(compiled(&package.generate(&["--store", store, "-o", "two"])?), 0)?;
    equal(package.files("one")?, package.files("two")?)?;
    // Records that came from the store are now in the machine's own cache.
    equal(compiled(&package.generate(&["-o", "three"])?), 0)
}
