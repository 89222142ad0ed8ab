//! One set of small bundles that every reader reads, or refuses with a sentence.
//!
//! The set is in `tests/bundles/` of the repository. `UPDATE_EXPECT=1` writes it: the bundles of
//! `readers/set.rs`, damaged copies of them, and `expected.txt`, which is what this package's loader
//! says about each. The readers in C and JavaScript print the same about the same files.

mod c;
mod damaged;
mod frames;
mod javascript;
mod set;
mod transcript;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use lamplight_bundle::{pack, write_directory};
use libtest_mimic::{Failed, Trial};

type Outcome = Result<(), Failed>;

pub fn tests() -> Vec<Trial> {
    let mut tests = vec![Trial::test("readers::set_is_current", set_is_current)];
    tests.extend(c::tests());
    tests.extend(javascript::tests());
    tests.extend(frames::tests());
    tests
}

/// Where the set is.
fn set_folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/bundles")
}

/// The files of the set, as they should be.
fn expected_files() -> Result<BTreeMap<String, Vec<u8>>, Failed> {
    let contents = set::contents();
    let packed = pack(&contents)?;
    let mut files: BTreeMap<String, Vec<u8>> = damaged::copies(&packed)?
        .into_iter()
        .map(|(name, bytes)| (format!("damaged/{name}.lamplight"), bytes))
        .collect();
    let folder = tempfile::tempdir()?;
    write_directory(&contents, folder.path())?;
    for name in ["index.bin", "manifest.json"] {
        files.insert(format!("good/{name}"), std::fs::read(folder.path().join(name))?);
    }
    for blob in std::fs::read_dir(folder.path().join("blobs"))? {
        let blob = blob?;
        let name = format!("good/blobs/{}", blob.file_name().to_string_lossy());
        files.insert(name, std::fs::read(blob.path())?);
    }
    let said = transcript::whole(&packed, folder.path(), &files)?;
    files.insert("good.lamplight".to_owned(), packed);
    files.insert("queries.txt".to_owned(), transcript::QUERIES.as_bytes().to_vec());
    files.insert("expected.txt".to_owned(), said.into_bytes());
    Ok(files)
}

/// The set is what its command writes today. So a change of the format is seen in it.
fn set_is_current() -> Outcome {
    let folder = set_folder();
    let files = expected_files()?;
    if std::env::var_os("UPDATE_EXPECT").is_some() {
        if folder.exists() {
            std::fs::remove_dir_all(&folder)?;
        }
        for (name, bytes) in &files {
            let place = folder.join(name);
            std::fs::create_dir_all(place.parent().unwrap_or(&folder))?;
            std::fs::write(place, bytes)?;
        }
    }
    for (name, bytes) in &files {
        let found = std::fs::read(folder.join(name)).unwrap_or_default();
        if found != *bytes {
            let command = "UPDATE_EXPECT=1 cargo test -p lamplight-bundle --test all readers::set";
            return Err(format!("tests/bundles/{name} is not current; run `{command}`").into());
        }
    }
    Ok(())
}
