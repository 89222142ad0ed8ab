//! What the identity of a build covers.

use std::fs;
use std::path::Path;

use lamplight_build::identity::{build_identity, collect_files, source_folders};
use libtest_mimic::{Failed, Trial};

pub fn tests() -> Vec<Trial> {
    vec![Trial::test("identity::every_package_counts", every_package_counts)]
}

/// Copies a file, or every file below a folder.
fn copy(from: &Path, to: &Path) -> Result<(), Failed> {
    let mut files = Vec::new();
    collect_files(from, &mut files)?;
    for file in files {
        let to = if file == from { to.to_owned() } else { to.join(file.strip_prefix(from)?) };
        fs::create_dir_all(to.parent().ok_or("no folder")?)?;
        fs::copy(&file, to)?;
    }
    Ok(())
}

/// One changed byte in any package, or in the library, is another identity. So is another setting.
fn every_package_counts() -> Result<(), Failed> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize()?;
    let scratch = tempfile::tempdir()?;
    let folders = source_folders(&root)?;
    for folder in &folders {
        copy(folder, &scratch.path().join(folder.strip_prefix(&root)?))?;
    }
    let identity = || build_identity(scratch.path(), &[b"lock".to_vec()]);
    let unchanged = identity()?;
    assert_eq!(unchanged, identity()?);
    let packages = fs::read_dir(root.join("crates"))?.count();
    assert!(folders.len() > packages, "{} folders of {packages} packages", folders.len());
    for folder in folders {
        let mut files = Vec::new();
        collect_files(&scratch.path().join(folder.strip_prefix(&root)?), &mut files)?;
        let file = files.first().ok_or("an empty folder")?;
        let bytes = fs::read(file)?;
        fs::write(file, [&bytes[..], b" "].concat())?;
        assert_ne!(unchanged, identity()?, "{}", file.display());
        fs::write(file, bytes)?;
    }
    assert_ne!(unchanged, build_identity(scratch.path(), &[b"other".to_vec()])?);
    Ok(())
}
