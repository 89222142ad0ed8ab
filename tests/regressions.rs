//! Inputs that once caused a failure, one file each in `tests/regressions/KIND/`. `cargo xtask fuzz`
//! or a person found them. Each must give the same answer twice, without a panic, within seconds.

#[path = "../fuzz/src/checks.rs"]
mod checks;
#[path = "../xtask/make/src/fuzz/ending.rs"]
mod ending;
#[path = "../fuzz/src/kinds.rs"]
pub mod kinds;
#[path = "../xtask/make/src/fuzz/mutate.rs"]
mod mutate;

use std::panic::catch_unwind;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

use kinds::{KINDS, Kind};
use lamplight::validate::on_large_stack;
use libtest_mimic::{Failed, Trial};

/// The longest time for one input. It is large, since the build is not optimised and the machine may
/// be busy.
const LONGEST: Duration = Duration::from_secs(10);

pub fn tests() -> Vec<Trial> {
    let seeds =
        all().map(|kind| Trial::test(format!("regressions::{}", kind.name), || seeded(kind)));
    let mutants = all()
        .map(|kind| Trial::test(format!("regressions::{}::mutants", kind.name), || mutants(kind)));
    seeds
        .chain(mutants)
        .chain([Trial::test("regressions::workers_that_fail", failed_workers)])
        .chain(all().flat_map(|kind| files(kind).into_iter().map(move |file| test(kind, file))))
        .collect()
}

fn all() -> impl Iterator<Item = &'static Kind> {
    KINDS.iter().chain(checks::KINDS)
}

/// Every kind of fuzzing has valid inputs to start from and, except for the binary `bundle`, words to
/// insert. Without them, fuzzing would hardly get past the first check of an input.
fn seeded(kind: &Kind) -> Result<(), Failed> {
    let is_there = |(folder, ending): &&(&str, &str)| {
        let mut found = Vec::new();
        mutate::collect(&Path::new(env!("CARGO_MANIFEST_DIR")).join(folder), ending, &mut found);
        !found.is_empty()
    };
    match kind.corpus.iter().find(|folder| !is_there(folder)) {
        Some((folder, ending)) => {
            let what = format!("the folder {folder} has no files `{ending}`");
            Err(format!("{}: {what}", kind.name).into())
        }
        None if kind.words.is_empty() && kind.name != "bundle" => {
            Err(format!("{} has no words to insert", kind.name).into())
        }
        None => Ok(()),
    }
}

/// A worker that could not work, or panicked, is an error of `cargo xtask fuzz`. It must not count as
/// a worker that found nothing.
fn failed_workers() -> Result<(), Failed> {
    let ended = |script: &str| {
        let status = Command::new("sh").args(["-c", script]).status()?;
        Ok::<_, Failed>(ending::read_ending(status, "message"))
    };
    for (script, expected) in [
        ("exit 0", Ok(None)),
        ("exit 3", Ok(Some("message"))),
        ("exit 4", Err("a worker ended with code 4: message")),
        ("exit 101", Err("a worker ended with code 101: message")),
        ("kill -9 $$", Ok(Some("aborts (signal: 9 (SIGKILL))"))),
    ] {
        let found = ended(script)?;
        let found = found.as_ref().map(Option::as_deref).map_err(String::as_str);
        if found != expected {
            return Err(format!("`{script}` should be {expected:?}, found {found:?}").into());
        }
    }
    Ok(())
}

/// The number of mutants for each kind. They are made from valid inputs, with the same seed in every
/// run. `LAMPLIGHT_FUZZ_INPUTS` and `LAMPLIGHT_FUZZ_SEED` set another number and another seed.
/// `cargo xtask fuzz` uses the same generator.
const MUTANTS: u64 = 100;

fn mutants(kind: &Kind) -> Result<(), Failed> {
    let number = |name: &str, usual| match std::env::var(name) {
        Ok(text) => text.parse().map_err(|_| Failed::from(format!("{name} is not a number"))),
        Err(_) => Ok(usual),
    };
    let count: u64 = number("LAMPLIGHT_FUZZ_INPUTS", MUTANTS)?;
    let mut random = mutate::FuzzRandom(number("LAMPLIGHT_FUZZ_SEED", 1)?);
    let corpus = mutate::corpus_of(Path::new(env!("CARGO_MANIFEST_DIR")), kind.corpus);
    let words: Vec<&str> = kind.words.split_whitespace().collect();
    for index in 0..count {
        let input = mutate::mutated(&mut random, &corpus, &words);
        let outcome = catch_unwind(|| answer(kind, &input));
        let failed = outcome.unwrap_or_else(|_| Err("it panicked".into()));
        failed.map_err(|failed| {
            let path =
                Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{}.{index}", kind.name));
            let kept = std::fs::write(&path, &input).map(|()| path);
            let reason = failed.message().unwrap_or_default();
            format!("{} mutant {index}: {reason}; its input is in {kept:?}", kind.name)
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

fn test(kind: &'static Kind, file: PathBuf) -> Trial {
    let name = file.file_name().unwrap_or_default().to_string_lossy().into_owned();
    Trial::test(format!("regressions::{}::{name}", kind.name), move || replay(kind, &file))
}

fn replay(kind: &Kind, file: &Path) -> Result<(), Failed> {
    answer(kind, &std::fs::read(file)?)
}

/// Fails unless an input gives the same answer twice, and soon. The shorter of the two times counts,
/// since other tests can take the machine for seconds.
fn answer(kind: &Kind, input: &[u8]) -> Result<(), Failed> {
    let (answer, first) = timed(kind, input);
    let (again, second) = timed(kind, input);
    let took = first.min(second);
    if took > LONGEST {
        return Err(format!("took {took:?}, expected at most {LONGEST:?}").into());
    }
    match again == answer {
        true => Ok(()),
        false => Err("the same input gave two different answers".into()),
    }
}

/// The answer to an input, and how long it took. The clock starts on a thread that may call naga,
/// since all tests share these threads and wait for one.
fn timed(kind: &Kind, input: &[u8]) -> (String, Duration) {
    on_large_stack(|| {
        let started = Instant::now();
        ((kind.run)(input), started.elapsed())
    })
}
