//! `cargo xtask random`: random programs, graphics and compute, whose outputs in all targets are run
//! and compared with the evaluator, by the tests `link::random` and `compute::random`; and programs in
//! GLSL, whose translation is compared with glslang's code by `glsl_values::random`.

use std::time::{Instant, SystemTime};

use xtask::{CommandFailure, CommandResult, process};

const USAGE: &str =
    "usage: cargo xtask random [--programs N] [--seed N] [--kind graphics|compute|glsl]

  --programs N  how many in all, a third of each kind (20000)
  --seed N      the seed of the first program of each kind (the time)
  --kind KIND   only this kind

A process runs 1000 programs: if a driver crashes, the rest is run all the same. Findings are left in
target/fuzz/link/ and target/fuzz/compute/, those of glsl are printed, and they give exit code 3.";

/// How many programs one process runs.
const BLOCK: u64 = 1000;

const TESTS: [&str; 7] =
    ["test", "--quiet", "--package", "lamplight", "--features", "store", "--test"];

/// The kinds of programs: the prefix of the test's variables, the test, and other variables.
const KINDS: [Kind; 3] = [
    Kind { name: "graphics", prefix: "LAMPLIGHT_LINK", test: "link::random" },
    Kind { name: "compute", prefix: "LAMPLIGHT_COMPUTE", test: "compute::random" },
    Kind { name: "glsl", prefix: "LAMPLIGHT_GLSL", test: "glsl_values::random" },
];

struct Kind {
    name: &'static str,
    /// How the names of the test's variables begin.
    prefix: &'static str,
    test: &'static str,
}

/// Runs all kinds, even if the first one has findings.
pub fn run(arguments: &[String]) -> CommandResult {
    let now = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH);
    let (mut programs, mut seed) = (20_000, now.map_or(1, |since| since.as_secs()));
    let mut kinds: Vec<&Kind> = KINDS.iter().collect();
    let mut rest = arguments.iter();
    while let Some(argument) = rest.next() {
        let value = rest.next().ok_or_else(|| CommandFailure::usage(USAGE))?;
        let number = value.parse::<u64>().map_err(|_| CommandFailure::usage(USAGE));
        match argument.as_str() {
            "--programs" => programs = number?,
            "--seed" => seed = number?,
            "--kind" => kinds.retain(|kind| kind.name == value),
            _ => return Err(CommandFailure::usage(USAGE)),
        }
    }
    if kinds.is_empty() {
        return Err(CommandFailure::usage(USAGE));
    }
    println!("seed {seed}: {programs} programs");
    // What does not build is no finding.
    process::cargo(&[&TESTS[..], &["all", "--no-run"]].concat(), &[])?;
    let (started, mut failed) = (Instant::now(), Vec::new());
    let count = kinds.len() as u64;
    for (index, kind) in kinds.iter().enumerate() {
        // The rest of the division goes to the first kind.
        let own = programs / count + if index == 0 { programs % count } else { 0 };
        let blocks = (0..own).step_by(BLOCK as usize);
        for first in blocks {
            let (seed, programs) = (seed + first, BLOCK.min(own - first));
            if tests(kind, programs, seed).is_err() {
                failed.push(format!("{} {seed} to {}", kind.name, seed + programs - 1));
            }
        }
    }
    let seconds = started.elapsed().as_secs_f64();
    println!(
        "seed {seed}: {programs} programs in {seconds:.0} s, {:.1} a second",
        programs as f64 / seconds
    );
    match failed.is_empty() {
        true => Ok(()),
        false => Err(CommandFailure::check(format!(
            "seed {seed}: findings among these seeds: {}",
            failed.join(", ")
        ))),
    }
}

fn tests(kind: &Kind, programs: u64, seed: u64) -> CommandResult {
    let command = [&TESTS[..], &["all"]].concat();
    let variable = |name: &str, value: String| (format!("{}_{name}", kind.prefix), value);
    let variables = [
        variable("PROGRAMS", programs.to_string()),
        variable("SEED", seed.to_string()),
        variable("RUN", "1".to_owned()),
    ];
    process::cargo_with(&command, &[kind.test.to_owned(), "--nocapture".to_owned()], &variables)
}
