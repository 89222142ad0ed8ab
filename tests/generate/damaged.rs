//! Bundles of an up-to-date run that are damaged afterwards. `gen` repairs them, `gen --check`,
//! `merge` and `bundle verify` report them.

use std::fs::{self, File};
use std::io::Write;
use std::path::{Path, PathBuf};

use super::{Outcome, Package, ensure, equal};

/// Damages a bundle at a path.
type Damage = fn(&Path) -> Outcome;

const FOLDER: [(&str, Damage); 12] = [
    ("a blob has another text", |at| Ok(fs::write(blob(at, 0)?, "something else")?)),
    ("a blob is empty", |at| Ok(fs::write(blob(at, 0)?, "")?)),
    ("a blob is cut", |at| cut(&blob(at, 1)?)),
    ("a blob has a byte more", |at| lengthen(&blob(at, 1)?)),
    ("a blob has a flipped bit", |at| flip(&blob(at, 2)?)),
    ("a blob has a flipped bit, and its old size and time", |at| {
        let path = blob(at, 2)?;
        let modified = fs::metadata(&path)?.modified()?;
        flip(&path)?;
        Ok(File::options().write(true).open(path)?.set_modified(modified)?)
    }),
    ("two blobs are exchanged", |at| {
        let (left, right, third) = (blob(at, 0)?, blob(at, 1)?, at.join("third"));
        fs::rename(&left, &third)?;
        fs::rename(&right, &left)?;
        Ok(fs::rename(third, right)?)
    }),
    ("a blob is absent", |at| Ok(fs::remove_file(blob(at, 0)?)?)),
    ("all blobs are absent", |at| Ok(fs::remove_dir_all(at.join("blobs"))?)),
    ("the manifest has a flipped bit", |at| flip(&at.join("manifest.json"))),
    ("the manifest has a byte that is not UTF-8", |at| {
        let (path, mut bytes) = (at.join("manifest.json"), fs::read(at.join("manifest.json"))?);
        let middle = bytes.len() / 2;
        bytes[middle] |= 0x80;
        Ok(fs::write(path, bytes)?)
    }),
    ("the manifest is cut", |at| cut(&at.join("manifest.json"))),
];

const FILE: [(&str, Damage); 5] = [
    ("the file is empty", |at| Ok(fs::write(at, "")?)),
    ("the file is cut", cut),
    ("the file has a byte more", lengthen),
    ("the file has a flipped bit", flip),
    ("the file is absent", |at| Ok(fs::remove_file(at)?)),
];

pub fn bundles() -> Outcome {
    damage_each("bundle", &FOLDER)?;
    damage_each("bundle.lamplight", &FILE)
}

fn damage_each(out: &str, ways: &[(&str, Damage)]) -> Outcome {
    let package = Package::new()?;
    package.generate(&["-o", out])?;
    let before = bytes(&package, out)?;
    for (what, damage) in ways {
        damage(&package.path().join(out))?;
        for command in [
            &["gen", "--check", "--cache", "cache", "-o", out][..],
            &["bundle", "verify", out],
            &["merge", "merged", out],
        ] {
            let output = package.run(command)?;
            let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
            ensure(
                matches!(output.status.code(), Some(1 | 3)) && stderr.contains("error: "),
                format!("`{}` of a bundle, where {what}: {stderr}", command.join(" ")),
            )?;
            ensure(!package.path().join("merged").exists(), format!("merged, where {what}"))?;
        }
        package.generate(&["-o", out]).map_err(|failed| format!("{what}: {failed:?}"))?;
        let is_repaired = bytes(&package, out)? == before;
        ensure(is_repaired, format!("`gen` does not repair a bundle, where {what}"))?;
        let check = package.run(&["gen", "--check", "--cache", "cache", "-o", out])?;
        equal(check.status.code(), Some(0))?;
    }
    Ok(())
}

/// The content of every file of the bundle.
fn bytes(package: &Package, out: &str) -> Result<Vec<(String, Vec<u8>)>, libtest_mimic::Failed> {
    let path = package.path().join(out);
    if path.is_file() {
        return Ok(vec![(out.to_owned(), fs::read(path)?)]);
    }
    Ok(package.files(out)?.into_iter().collect())
}

/// One of the blobs, by its place among the sorted names.
fn blob(bundle: &Path, index: usize) -> Result<PathBuf, libtest_mimic::Failed> {
    let entries = fs::read_dir(bundle.join("blobs"))?;
    let mut paths: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    paths.sort();
    Ok(paths.into_iter().nth(index).ok_or("too few blobs")?)
}

fn cut(path: &Path) -> Outcome {
    let bytes = fs::read(path)?;
    Ok(fs::write(path, &bytes[..bytes.len() - 1])?)
}

fn lengthen(path: &Path) -> Outcome {
    Ok(File::options().append(true).open(path)?.write_all(b"x")?)
}

/// Flips a bit in place: the file stays the same file.
fn flip(path: &Path) -> Outcome {
    let mut bytes = fs::read(path)?;
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    Ok(fs::write(path, bytes)?)
}
