//! Inputs that once did harm, one file each in `tests/regressions/KIND/`: `cargo xtask fuzz`
//! found them, or a person did. Each must have one answer, without a panic, in a moment.

#[path = "../fuzz/src/kinds.rs"]
pub mod kinds;
#[path = "../fuzz/src/proofs.rs"]
mod proofs;

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use kinds::{KINDS, Kind};
use libtest_mimic::{Failed, Trial};

/// Generous, since the profile is not for speed and the machine may be busy.
const LONGEST: Duration = Duration::from_secs(10);

pub fn trials() -> Vec<Trial> {
    let seeds =
        all().map(|kind| Trial::test(format!("regressions::{}", kind.name), || seeded(kind)));
    seeds
        .chain(all().flat_map(|kind| files(kind).into_iter().map(move |file| trial(kind, file))))
        .collect()
}

fn all() -> impl Iterator<Item = &'static Kind> {
    KINDS.iter().chain(proofs::KINDS)
}

/// A kind without valid inputs to start from would be fuzzed in vain.
fn seeded(kind: &Kind) -> Result<(), Failed> {
    let is_there =
        |(folder, _): &&(&str, &str)| Path::new(env!("CARGO_MANIFEST_DIR")).join(folder).is_dir();
    match kind.corpus.iter().find(|folder| !is_there(folder)) {
        Some((folder, ending)) => {
            Err(format!("no folder {folder} with files of `{ending}`").into())
        }
        None if kind.words.is_empty() && kind.name != "bundle" => Err("no words".into()),
        None => Ok(()),
    }
}

fn files(kind: &Kind) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/regressions").join(kind.name);
    let mut found: Vec<PathBuf> = std::fs::read_dir(folder)
        .into_iter()
        .flatten()
        .flatten()
        .map(|entry| entry.path())
        .collect();
    found.sort();
    found
}

fn trial(kind: &'static Kind, file: PathBuf) -> Trial {
    let name = file.file_name().unwrap_or_default().to_string_lossy().into_owned();
    Trial::test(format!("regressions::{}::{name}", kind.name), move || replay(kind, &file))
}

fn replay(kind: &Kind, file: &Path) -> Result<(), Failed> {
    let input = std::fs::read(file)?;
    let started = Instant::now();
    let answer = (kind.run)(&input);
    if started.elapsed() > LONGEST {
        return Err(format!("took {:?}", started.elapsed()).into());
    }
    if (kind.run)(&input) == answer { Ok(()) } else { Err("two answers to one input".into()) }
}
