//! Inputs that once did harm, one file each in `tests/regressions/KIND/`: `cargo xtask fuzz`
//! found them, or a person did. Each must have one answer, without a panic, in a moment.

#[path = "../fuzz/src/kinds.rs"]
pub mod kinds;
#[path = "../xtask/src/fuzz/mutate.rs"]
mod mutate;
#[path = "../fuzz/src/proofs.rs"]
mod proofs;

use std::panic::catch_unwind;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use kinds::{KINDS, Kind};
use libtest_mimic::{Failed, Trial};

/// Generous, since the profile is not for speed and the machine may be busy.
const LONGEST: Duration = Duration::from_secs(10);

pub fn trials() -> Vec<Trial> {
    let seeds =
        all().map(|kind| Trial::test(format!("regressions::{}", kind.name), || seeded(kind)));
    let mutants = all()
        .map(|kind| Trial::test(format!("regressions::{}::mutants", kind.name), || mutants(kind)));
    seeds
        .chain(mutants)
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

/// Mutants of valid inputs that each kind is given, from the same seed each time:
/// `LAMPLIGHT_FUZZ_INPUTS` and `LAMPLIGHT_FUZZ_SEED` ask for others. The generator is that of
/// `cargo xtask fuzz`, which tries kinds that need the harness from outside alone.
const MUTANTS: u64 = 100;

fn mutants(kind: &Kind) -> Result<(), Failed> {
    let number = |name: &str, usual| match std::env::var(name) {
        Ok(text) => text.parse().map_err(|_| Failed::from(format!("{name} is no number"))),
        Err(_) => Ok(usual),
    };
    let count: u64 = number("LAMPLIGHT_FUZZ_INPUTS", MUTANTS)?;
    let mut random = mutate::Random(number("LAMPLIGHT_FUZZ_SEED", 1)?);
    let corpus = mutate::corpus(Path::new(env!("CARGO_MANIFEST_DIR")), kind);
    let words: Vec<&str> = kind.words.split_whitespace().collect();
    for index in 0..count {
        let input = mutate::mutated(&mut random, &corpus, &words);
        let judged = catch_unwind(|| judge(kind, &input));
        let failed = judged.unwrap_or_else(|_| Err("it panicked".into()));
        failed.map_err(|failed| {
            let path =
                Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{}.{index}", kind.name));
            let kept = std::fs::write(&path, &input).map(|()| path);
            let reason = failed.message().unwrap_or_default();
            format!("mutant {index}: {reason}; it is in {kept:?}")
        })?;
    }
    Ok(())
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
    judge(kind, &std::fs::read(file)?)
}

/// An input has one answer, soon.
fn judge(kind: &Kind, input: &[u8]) -> Result<(), Failed> {
    let started = Instant::now();
    let answer = (kind.run)(input);
    if started.elapsed() > LONGEST {
        return Err(format!("took {:?}", started.elapsed()).into());
    }
    if (kind.run)(input) == answer { Ok(()) } else { Err("two answers to one input".into()) }
}
