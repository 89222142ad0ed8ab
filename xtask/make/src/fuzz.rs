//! `cargo xtask fuzz`: tries hostile inputs on everything that reads files from others.
//!
//! A worker process mutates inputs and checks the answers. This process watches it, so that an
//! abort or an endless loop is a finding too. Findings are made smaller and kept in
//! `tests/regressions/KIND/`.

mod answer;
mod commands;
mod ending;
#[path = "../../../fuzz/src/kinds.rs"]
mod kinds;
mod link;
mod mutate;

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant, SystemTime};

use kinds::{KINDS, Kind};
use mutate::FuzzRandom;
use xtask::process::root;
use xtask::{CommandFailure, CommandResult};

const USAGE: &str = "usage: cargo xtask fuzz [--seconds N] [--seed N] [KIND]...\n       cargo xtask fuzz link [--programs N] [--seed N]";
/// A worker that gives no sign of life for this long is in an endless loop.
const PATIENCE: Duration = Duration::from_secs(20);
/// The most smaller inputs that are tried to shrink a finding.
const SHRINKS: usize = 400;

/// What was asked for.
struct FuzzRequest {
    seconds: u64,
    seed: u64,
    kinds: Vec<&'static Kind>,
    surfaces: Vec<&'static commands::Surface>,
}

/// Fuzzes every kind for its share of the time. A finding gives exit code 3.
pub fn run(arguments: &[String]) -> CommandResult {
    match arguments {
        [kind, rest @ ..] if kind == "link" => link::run(rest),
        [mode, kind, file] if mode == "--check" => check_file(find(kind)?, Path::new(file)),
        [mode, kind, seed, seconds] if mode == "--work" => {
            work(find(kind)?, number(seed)?, number(seconds)?)
        }
        _ => watch(&request(arguments)?),
    }
}

fn request(arguments: &[String]) -> Result<FuzzRequest, CommandFailure> {
    let now =
        SystemTime::now().duration_since(SystemTime::UNIX_EPOCH).map_or(0, |since| since.as_secs());
    let mut request =
        FuzzRequest { seconds: 60, seed: now, kinds: Vec::new(), surfaces: Vec::new() };
    let mut rest = arguments.iter();
    while let Some(argument) = rest.next() {
        match argument.as_str() {
            "--seconds" => {
                request.seconds = number(rest.next().ok_or_else(|| CommandFailure::usage(USAGE))?)?
            }
            "--seed" => {
                request.seed = number(rest.next().ok_or_else(|| CommandFailure::usage(USAGE))?)?
            }
            name => match commands::SURFACES.iter().find(|surface| surface.name == name) {
                Some(surface) => request.surfaces.push(surface),
                None => request.kinds.push(find(name)?),
            },
        }
    }
    if request.kinds.is_empty() && request.surfaces.is_empty() {
        request.kinds = KINDS.iter().collect();
        request.surfaces = commands::SURFACES.iter().collect();
    }
    Ok(request)
}

fn number(text: &str) -> Result<u64, CommandFailure> {
    text.parse().map_err(|_| CommandFailure::usage(USAGE))
}

fn find(name: &str) -> Result<&'static Kind, CommandFailure> {
    let names = KINDS.iter().map(|kind| kind.name);
    let names: Vec<&str> =
        names.chain(commands::SURFACES.iter().map(|surface| surface.name)).collect();
    let found = KINDS.iter().find(|kind| kind.name == name);
    found.ok_or_else(|| CommandFailure::usage(format!("{USAGE}\nkinds: {}", names.join(", "))))
}

fn watch(request: &FuzzRequest) -> CommandResult {
    println!("seed {}", request.seed);
    let all = request.kinds.len() + request.surfaces.len();
    let share = (request.seconds / all as u64).max(1);
    let mut findings = 0;
    for kind in &request.kinds {
        findings += fuzz(kind, request.seed, share)?;
    }
    for surface in &request.surfaces {
        findings += commands::fuzz(surface, request.seed, share)?;
    }
    if findings == 0 {
        Ok(())
    } else {
        Err(CommandFailure::check(format!("{findings} findings in tests/regressions/")))
    }
}

/// Runs workers until the time is over. Each finding ends a worker.
fn fuzz(kind: &Kind, seed: u64, seconds: u64) -> Result<usize, CommandFailure> {
    let (started, mut reasons, mut round) = (Instant::now(), BTreeSet::new(), 0);
    while started.elapsed().as_secs() < seconds {
        let rest = seconds - started.elapsed().as_secs();
        let worker = spawn(&[
            "--work",
            kind.name,
            &seed.wrapping_add(round).to_string(),
            &rest.to_string(),
        ])?;
        let Some(reason) = outcome(worker, Some(&current(kind)))? else { break };
        round += 1;
        let input = fs::read(current(kind)).map_err(environment)?;
        if reasons.insert(reason.clone()) {
            keep(kind, input, &reason)?;
        }
    }
    Ok(reasons.len())
}

/// The file in which a worker leaves the input that it is about to check.
fn current(kind: &Kind) -> PathBuf {
    root().join("target/fuzz").join(kind.name)
}

fn spawn(arguments: &[&str]) -> Result<Child, CommandFailure> {
    let program = std::env::current_exe().map_err(environment)?;
    Command::new(program)
        .arg("fuzz")
        .args(arguments)
        .stderr(Stdio::piped())
        .spawn()
        .map_err(environment)
}

/// Waits for a worker, and returns what it found wrong. `sign` is a file that a live worker keeps
/// writing; a worker whose file is old is killed.
fn outcome(mut worker: Child, sign: Option<&Path>) -> Result<Option<String>, CommandFailure> {
    let started = Instant::now();
    loop {
        if let Ok(Some(status)) = worker.try_wait() {
            let message = worker.wait_with_output().map(|output| output.stderr).unwrap_or_default();
            let message = String::from_utf8_lossy(&message);
            return ending::read_ending(status, message.trim())
                .map_err(CommandFailure::environment);
        }
        let alive = sign.and_then(|sign| fs::metadata(sign).ok()?.modified().ok()?.elapsed().ok());
        if started.elapsed() > PATIENCE && alive.is_none_or(|since| since > PATIENCE) {
            let _ = worker.kill();
            let _ = worker.wait();
            return Ok(Some("does not end".to_owned()));
        }
        std::thread::sleep(Duration::from_millis(5));
    }
}

/// The worker: mutates inputs and checks the answers, until the time is over or something is wrong.
fn work(kind: &Kind, seed: u64, seconds: u64) -> CommandResult {
    let place = current(kind);
    fs::create_dir_all(place.parent().unwrap_or(Path::new("."))).map_err(environment)?;
    let (corpus, words): (_, Vec<&str>) = (
        mutate::corpus_of(&root(), kind.corpus),
        kind.words.split(' ').filter(|word| !word.is_empty()).collect(),
    );
    let (mut random, started, mut inputs) = (FuzzRandom(seed), Instant::now(), 0u64);
    answer::quiet();
    while started.elapsed().as_secs() < seconds {
        let input = mutate::mutated(&mut random, &corpus, &words);
        fs::write(&place, &input).map_err(environment)?;
        inputs += 1;
        if let Some(reason) = answer::problem_with(kind, &input) {
            return Err(CommandFailure::check(reason));
        }
    }
    println!("{}: {inputs} inputs, nothing found", kind.name);
    Ok(())
}

fn check_file(kind: &Kind, file: &Path) -> CommandResult {
    let input = fs::read(file).map_err(environment)?;
    answer::quiet();
    answer::problem_with(kind, &input).map_or(Ok(()), |reason| Err(CommandFailure::check(reason)))
}

/// Saves a finding, shrunk as far as it still fails for the same reason.
fn keep(kind: &Kind, input: Vec<u8>, reason: &str) -> CommandResult {
    println!("{}: {reason} ({} bytes)", kind.name, input.len());
    let small = shrunk(kind, input, reason)?;
    let folder = root().join("tests/regressions").join(kind.name);
    fs::create_dir_all(&folder).map_err(environment)?;
    let name: String = reason
        .chars()
        .map(|c| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '_' })
        .collect();
    println!("  kept as tests/regressions/{}/{name} ({} bytes)", kind.name, small.len());
    fs::write(folder.join(name), small).map_err(environment)
}

/// Removes ever smaller parts of the input, as long as it still fails for the same reason.
fn shrunk(kind: &Kind, mut input: Vec<u8>, reason: &str) -> Result<Vec<u8>, CommandFailure> {
    let file = current(kind).with_extension("small");
    let (mut size, mut at, mut tries) = (input.len() / 2, 0, 0);
    while size > 0 && tries < SHRINKS {
        if at >= input.len() {
            (size, at) = (size / 2, 0);
            continue;
        }
        let end = (at + size).min(input.len());
        let smaller = [&input[..at], &input[end..]].concat();
        fs::write(&file, &smaller).map_err(environment)?;
        tries += 1;
        let worker = spawn(&["--check", kind.name, &file.to_string_lossy()])?;
        match outcome(worker, None)? {
            Some(same) if same == reason => input = smaller,
            _ => at = end,
        }
    }
    Ok(input)
}

fn environment(error: std::io::Error) -> CommandFailure {
    CommandFailure::environment(error.to_string())
}
