//! `cargo xtask test nightly`: every test, then what the tests only sample, whole.

use xtask::{CommandFailure, CommandResult, process};

use crate::{ci, faults, frames, mutate, random};

/// A part: what it does, and the command that does it.
type NightlyPart = (&'static str, fn() -> CommandResult);

const PARTS: [NightlyPart; 7] = [
    ("every test, whole", every_test),
    ("frames from the bytes of every target", || frames::run(&[])),
    ("20,000 random programs", || random::run(&words("--programs 20000"))),
    ("mutants of the whole library", || mutate::run(&[])),
    ("mutants that references share", || mutate::run(&words("--shared"))),
    ("faults of the system", || faults::run(&[])),
    ("packages as they are published", ci::check_publishing),
];

/// Runs the tests with the variable that makes them take everything.
fn every_test() -> CommandResult {
    let whole = [("LAMPLIGHT_WHOLE".to_owned(), "1".to_owned())];
    process::cargo_with(&["xtask", "test"], &[], &whole)
}

fn words(line: &str) -> Vec<String> {
    line.split_whitespace().map(str::to_owned).collect()
}

/// Runs every part, even after one that fails, and lists those that failed.
pub fn run(arguments: &[String]) -> CommandResult {
    if !arguments.is_empty() {
        return Err(CommandFailure::usage("usage: cargo xtask test nightly"));
    }
    let mut failed = Vec::new();
    for (name, part) in PARTS {
        println!("nightly: {name}");
        if part().is_err() {
            failed.push(name);
        }
    }
    match failed.is_empty() {
        true => Ok(()),
        false => Err(CommandFailure::check(format!("failed: {}", failed.join("; ")))),
    }
}
