//! Random programs, judged by the rules and by Tint.
//!
//! `verdicts.txt` has what Tint 2026 says of the first programs: a `1` for each that it accepts.
//! Where the command `tint` is installed, it is asked again, and about more programs:
//! `LAMPLIGHT_RULES_PROGRAMS` says about how many, `LAMPLIGHT_RULES_SEED` from which on.

use std::path::Path;
use std::process::Command;

use libtest_mimic::{Failed, Trial};

use crate::errors;
use crate::programs::program;
use crate::random::asked_number;

const RECORDED: &str = include_str!("verdicts.txt");

/// How many programs Tint is asked about.
const ASKED: u64 = 300;

pub fn tests() -> Vec<Trial> {
    vec![
        Trial::test("rules::recorded_verdicts", recorded_verdicts),
        Trial::test("rules::verdicts_of_tint", verdicts_of_tint)
            .with_ignored_flag(tint("--help").is_err()),
    ]
}

fn recorded_verdicts() -> Result<(), Failed> {
    let verdicts = RECORDED.chars().filter(|letter| !letter.is_whitespace());
    for (seed, verdict) in verdicts.enumerate() {
        compare(seed as u64, verdict == '1')?;
    }
    Ok(())
}

fn compare(seed: u64, is_accepted: bool) -> Result<(), Failed> {
    let text = program(seed);
    let found = errors(&text);
    match found.is_empty() == is_accepted {
        true => Ok(()),
        false => Err(format!("Tint accepts {seed}: {is_accepted}, but {found:#?}\n{text}").into()),
    }
}

fn verdicts_of_tint() -> Result<(), Failed> {
    let seed = asked_number("LAMPLIGHT_RULES_SEED", 0);
    let folder = tempfile::tempdir()?;
    let mut recorded = String::new();
    for seed in seed..seed + asked_number("LAMPLIGHT_RULES_PROGRAMS", ASKED) {
        let file = folder.path().join(format!("{seed}.wgsl"));
        std::fs::write(&file, program(seed))?;
        let is_accepted = accepts(&file)?;
        recorded.push(if is_accepted { '1' } else { '0' });
        compare(seed, is_accepted)?;
    }
    println!("{recorded}");
    Ok(())
}

pub fn tint(argument: &str) -> std::io::Result<std::process::Output> {
    Command::new("tint").arg(argument).output()
}

pub fn accepts(file: &Path) -> std::io::Result<bool> {
    let output = Command::new("tint").args(["--format", "wgsl"]).arg(file).output()?;
    Ok(output.status.success())
}
