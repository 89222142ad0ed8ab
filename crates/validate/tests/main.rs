//! Whether random programs are accepted for browsers: they are where Tint, the compiler of Chromium,
//! accepts them.

#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

mod programs;

use std::process::{Command, Output};

use lamplight_bundle::Language;
use lamplight_compose::Composed;
use lamplight_diagnostic::Severity;
use lamplight_validate::{lint_wgsl, validate};
use libtest_mimic::{Failed, Trial};

/// What Tint 2026 says of the first programs: a `1` for each that it accepts.
const RECORDED: &str = include_str!("verdicts.txt");

/// How many programs Tint is asked about where it is installed.
const ASKED: u64 = 200;

fn main() -> std::process::ExitCode {
    lamplight_testing::run_tests(&[|| {
        vec![
            Trial::test("validate::recorded_verdicts", recorded_verdicts),
            Trial::test("validate::verdicts_of_tint", verdicts_of_tint)
                .with_ignored_flag(tint(&["--help"]).is_err()),
        ]
    }])
}

fn recorded_verdicts() -> Result<(), Failed> {
    let verdicts = RECORDED.chars().filter(|letter| !letter.is_whitespace());
    verdicts.zip(0..).try_for_each(|(verdict, seed)| compare(seed, verdict == '1'))
}

/// Asks Tint about other programs: `LAMPLIGHT_VERDICTS_PROGRAMS` says about how many, and
/// `LAMPLIGHT_VERDICTS_SEED` from which on.
fn verdicts_of_tint() -> Result<(), Failed> {
    let number =
        |name: &str, usual: u64| std::env::var(name).map_or(Ok(usual), |text| text.parse::<u64>());
    let first = number("LAMPLIGHT_VERDICTS_SEED", 0)?;
    let count = number("LAMPLIGHT_VERDICTS_PROGRAMS", ASKED)?;
    let (folder, mut recorded) = (tempfile::tempdir()?, String::new());
    let file = folder.path().join("program.wgsl");
    for seed in first..first + count {
        std::fs::write(&file, programs::program(seed))?;
        let is_accepted = tint(&["--format", "wgsl", &file.to_string_lossy()])?.status.success();
        recorded.push(if is_accepted { '1' } else { '0' });
        compare(seed, is_accepted)?;
    }
    println!("{recorded}");
    Ok(())
}

fn tint(arguments: &[&str]) -> std::io::Result<Output> {
    Command::new("tint").args(arguments).output()
}

fn compare(seed: u64, is_accepted: bool) -> Result<(), Failed> {
    let text = programs::program(seed);
    let composed = Composed::of_text(Language::Wesl, None, text.clone());
    let mut found = validate(&composed).err().unwrap_or_default();
    found.extend(lint_wgsl(&composed, true));
    found.retain(|one| one.severity == Severity::Error);
    match found.is_empty() == is_accepted {
        true => Ok(()),
        false => Err(format!("Tint accepts {seed}: {is_accepted}, but {found:#?}\n{text}").into()),
    }
}
