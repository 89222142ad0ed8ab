//! Random compute programs. Every executor gives what the evaluator gives.
//!
//! `seed -> program -> outputs -> executors -> bytes, compared number by number`
//!
//! The programs do nothing that WGSL leaves open. An invocation writes to elements of its own, or to
//! an atomic variable that only one function changes, whose order does not matter. Integers may have
//! any value; floats stay multiples of 1/4 below 64, so that each operation is exact.
//!
//! `cargo xtask random` runs the test `compute::random` with another seed and more programs.

mod body;
mod entry;
mod flow;
mod program;
mod run;
mod scope;
mod types;
mod values;

use std::collections::BTreeMap;
use std::fs;
use std::ops::Range;
use std::path::Path;
use std::time::Instant;

use super::Outcome;
use crate::is_whole;
use crate::link_random::shrink::shrunk;
use program::Program;
use run::{Finding, Runner};

/// How many programs the tests make by day, and at night.
const PROGRAMS: [u64; 2] = [100, 400];
/// The seed of the first program.
const SEED: u64 = 1;
/// How many programs are compiled and run together.
const BATCH: u64 = 50;
/// How many percent of the programs the crate may refuse.
const REFUSED: usize = 2;
/// How many of a thousand other programs may differ on one of Mesa's drivers, and not on SwiftShader: of
/// the same words of SPIR-V, or of the same GLSL, compiled by glslang. The program of seed 30412 does,
/// whose invocations leave a loop at different turns, and that of 7000080 in GLSL.
const DRIVER: usize = 2;
/// How many percent of the programs each executor must run at least: drivers and glslang lack things.
const LEAST: usize = 50;

/// What became of all programs.
#[derive(Default)]
pub struct Tally {
    programs: usize,
    /// How many programs were refused, for each first error, with the first seed.
    refused: BTreeMap<String, (usize, u64)>,
    /// How many outputs were run, by executor.
    ran: BTreeMap<&'static str, usize>,
    /// How many were not, by executor and reason.
    lacks: BTreeMap<String, usize>,
    numbers: usize,
    /// The seeds whose outputs differ on one driver and not on another, by executor.
    drivers: BTreeMap<&'static str, Vec<u64>>,
    /// The findings by kind: the seeds, and the first of them.
    findings: BTreeMap<String, (Vec<u64>, Finding)>,
}

/// A number from the environment, or the usual one.
fn number(name: &str, usual: u64) -> Result<u64, String> {
    match std::env::var(name) {
        Ok(text) => text.parse().map_err(|_| format!("{name} is not a number")),
        Err(_) => Ok(usual),
    }
}

pub fn programs() -> Outcome {
    let programs = number("LAMPLIGHT_COMPUTE_PROGRAMS", PROGRAMS[usize::from(is_whole())])?;
    let seed = number("LAMPLIGHT_COMPUTE_SEED", SEED)?;
    let mut runner = Runner::open()?;
    if std::env::var_os("LAMPLIGHT_COMPUTE_PRINT").is_some() {
        println!("{}", program(seed).text);
    }
    let (mut tally, started, mut next) = (Tally::default(), Instant::now(), seed);
    let mut reported = 0;
    while next < seed + programs {
        let end = (next + BATCH).min(seed + programs);
        tally.batch(next..end, &mut runner);
        next = end;
        if programs > BATCH {
            let pace = tally.programs as f64 / started.elapsed().as_secs_f64();
            let kinds = tally.findings.len();
            println!(
                "{} of {programs} compute programs, {pace:.1} a second, {kinds} kinds of findings",
                tally.programs
            );
        }
        if tally.findings.len() > reported {
            reported = tally.findings.len();
            report(&tally, &mut runner)?;
        }
    }
    println!("{tally}");
    let refused: usize = tally.refused.values().map(|(count, _)| count).sum();
    if refused * 100 > REFUSED * tally.programs {
        return Err(format!("the crate refuses {refused} of the programs: {tally}").into());
    }
    if let Some((name, seeds)) = tally
        .drivers
        .iter()
        .find(|(_, seeds)| seeds.len() > 1 && seeds.len() * 1000 > DRIVER * tally.programs)
    {
        return Err(format!("one driver of `{name}` differs too often: {seeds:?}").into());
    }
    let ran = |name: &str| tally.ran.get(name).copied().unwrap_or(0);
    if let Some(name) = runner.names().find(|name| ran(name) * 100 < LEAST * tally.programs) {
        return Err(format!("`{name}` ran {} of the programs: {tally}", ran(name)).into());
    }
    match tally.findings.first_key_value() {
        None => Ok(()),
        Some((kind, (_, first))) => Err(format!("{tally}\n{kind}: {}", first.about).into()),
    }
}

/// The program of a seed. The environment may name a file with another text for it, such as one that
/// somebody made smaller.
fn program(seed: u64) -> Program {
    let program = Program::new(seed);
    match std::env::var_os("LAMPLIGHT_COMPUTE_TEXT") {
        Some(file) => Program { text: fs::read_to_string(file).unwrap_or_default(), ..program },
        None => program,
    }
}

/// Writes the first finding of each kind to a file, made smaller if that is asked for.
fn report(tally: &Tally, runner: &mut Runner) -> Outcome {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("target/fuzz/compute");
    fs::create_dir_all(&folder)?;
    for (kind, (seeds, first)) in &tally.findings {
        let plain = |letter: char| if letter.is_ascii_alphanumeric() { letter } else { '_' };
        let name: String = kind.chars().map(plain).take(60).collect();
        let file = folder.join(format!("{name}_{}.txt", seeds[0]));
        if file.exists() {
            continue;
        }
        let program = program(seeds[0]);
        let mut text = program.text.clone();
        if std::env::var_os("LAMPLIGHT_COMPUTE_SHRINK").is_some() {
            let runner = std::cell::RefCell::new(&mut *runner);
            let has = |text: &str| {
                let smaller = Program { text: text.to_owned(), ..program.clone() };
                is_defined(text, &program.text) && runner.borrow_mut().has(&smaller, kind)
            };
            text = shrunk(&program.text, &has);
        }
        fs::write(&file, format!("seed {}: {kind}\n\n{text}\n{}\n", seeds[0], first.about))?;
        println!("{}", file.display());
    }
    Ok(())
}

/// Whether a smaller text has all barriers, without which its results are open.
fn is_defined(text: &str, whole: &str) -> bool {
    ["Barrier", "if index =="]
        .iter()
        .all(|word| text.matches(word).count() == whole.matches(word).count())
}

impl Tally {
    fn batch(&mut self, seeds: Range<u64>, runner: &mut Runner) {
        let made: Vec<(u64, Program)> = seeds.map(|seed| (seed, program(seed))).collect();
        self.programs += made.len();
        for (index, finding) in runner.run(&made, self) {
            let found = self.findings.entry(finding.kind.clone());
            found.or_insert_with(|| (Vec::new(), finding)).0.push(made[index].0);
        }
    }
}

impl std::fmt::Display for Tally {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { programs, refused, ran, lacks, numbers, drivers, findings } = self;
        write!(f, "{programs} compute programs, {numbers} numbers, ran {ran:?}")?;
        write!(f, "\n  refused: {refused:?}\n  not run: {lacks:?}")?;
        write!(f, "\n  wrong on one driver alone: {drivers:?}\n  findings:")?;
        for (kind, (seeds, _)) in findings {
            let first: Vec<String> = seeds.iter().take(8).map(u64::to_string).collect();
            write!(f, "\n  {} x {kind} (seeds {})", seeds.len(), first.join(", "))?;
        }
        if findings.is_empty() { f.write_str(" none") } else { Ok(()) }
    }
}
