//! The reader in C: compiled by each compiler as each language, and run on the set and on crafted
//! bundles under sanitizers.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::Command;

use libtest_mimic::{Failed, Trial};

use super::{Outcome, set_folder};

/// Each compiler with the languages that the headers must be.
const COMPILERS: [(&str, &str); 8] = [
    ("gcc", "c99"),
    ("gcc", "c11"),
    ("clang", "c99"),
    ("clang", "c11"),
    ("g++", "c++11"),
    ("g++", "c++17"),
    ("clang++", "c++11"),
    ("clang++", "c++17"),
];

/// How many crafted bundles the tests read. `LAMPLIGHT_WHOLE=1` reads a million.
const CRAFTED: u32 = 2_000;
const CRAFTED_WHOLE: u32 = 1_000_000;

/// The most bytes of code of the reader, without a decoder.
const MOST_CODE: u64 = 60 * 1024;

pub fn tests() -> Vec<Trial> {
    let mut tests: Vec<Trial> = COMPILERS
        .into_iter()
        .map(|(compiler, language)| {
            let name = format!("readers::c::compiles::{compiler}_{language}");
            Trial::test(name, move || compiles(compiler, language))
        })
        .collect();
    tests.push(Trial::test("readers::c::says_what_the_loader_says", says_the_same));
    tests.push(Trial::test("readers::c::crafted_bundles_are_no_faults", crafted));
    tests.push(Trial::test("readers::c::is_small", is_small));
    tests
}

fn include_folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../include")
}

fn source(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/readers").join(name)
}

/// The output of a command that must end well.
pub fn output(command: &mut Command) -> Result<String, Failed> {
    let program = command.get_program().to_string_lossy().into_owned();
    let output = command.output().map_err(|error| format!("{program}: {error}"))?;
    if output.status.success() {
        return Ok(String::from_utf8_lossy(&output.stdout).into_owned());
    }
    Err(format!("{program}: {}", String::from_utf8_lossy(&output.stderr)).into())
}

fn compiler(program: &str, arguments: &[&str]) -> Command {
    let mut command = Command::new(program);
    command.args(["-Wall", "-Wextra", "-Wpedantic", "-Werror", "-I"]).arg(include_folder());
    command.args(arguments);
    command
}

fn compiles(program: &str, language: &str) -> Outcome {
    let standard = format!("-std={language}");
    let kind = if language.starts_with("c++") { "c++" } else { "c" };
    let mut command = compiler(program, &[&standard, "-fsyntax-only", "-x", kind]);
    output(command.arg(source("transcript.c")).arg(source("fuzz.c"))).map(drop)
}

/// A program of the folder, built with sanitizers that end it at the first fault.
pub fn build(name: &str, folder: &Path) -> Result<PathBuf, Failed> {
    let place = folder.join(name);
    let mut command = compiler(
        "gcc",
        &["-std=c99", "-O1", "-g", "-fsanitize=address,undefined", "-fno-sanitize-recover=all"],
    );
    output(command.arg(source(&format!("{name}.c"))).arg("-o").arg(&place))?;
    Ok(place)
}

fn run(
    program: &Path,
    arguments: impl IntoIterator<Item = impl AsRef<OsStr>>,
) -> Result<String, Failed> {
    output(Command::new(program).args(arguments))
}

fn says_the_same() -> Outcome {
    let folder = tempfile::tempdir()?;
    let (program, set) = (build("transcript", folder.path())?, set_folder());
    let expected = std::fs::read_to_string(set.join("expected.txt"))?;
    let place = set.to_string_lossy().into_owned();
    let damaged = run(&program, [place.as_str()].into_iter().chain(damaged_names(&expected)))?;
    for form in [&["good"][..], &["good", "directory"]] {
        let good = run(&program, [place.as_str()].into_iter().chain(form.iter().copied()))?;
        same_lines(&expected, &(good + &damaged))?;
    }
    Ok(())
}

/// The damaged files that a transcript names.
pub fn damaged_names(transcript: &str) -> impl Iterator<Item = &str> {
    let lines = transcript.lines().filter(|line| line.starts_with("damaged/"));
    lines.filter_map(|line| line.split(' ').next())
}

/// Names the first line that differs.
pub fn same_lines(expected: &str, found: &str) -> Outcome {
    for (number, (expected, found)) in expected.lines().zip(found.lines()).enumerate() {
        if expected != found {
            let line = number + 1;
            return Err(format!("line {line}: expected `{expected}`, found `{found}`").into());
        }
    }
    match (expected.lines().count(), found.lines().count()) {
        (expected, found) if expected == found => Ok(()),
        (expected, found) => Err(format!("expected {expected} lines, found {found}").into()),
    }
}

fn crafted() -> Outcome {
    let folder = tempfile::tempdir()?;
    let program = build("fuzz", folder.path())?;
    let is_whole = std::env::var_os("LAMPLIGHT_WHOLE").is_some();
    let count = if is_whole { CRAFTED_WHOLE } else { CRAFTED }.to_string();
    let bundle = set_folder().join("good.lamplight");
    let said = run(&program, [bundle.as_os_str(), OsStr::new(&count), OsStr::new("1")])?;
    println!("{}", said.trim());
    let figures: Vec<u32> = said.split([' ', ':']).filter_map(|word| word.parse().ok()).collect();
    // Most changes must get past the checksums, or this tests nothing.
    match figures[..] {
        [all, opened, found, read] if opened > all / 4 && found > all / 10 && read > all / 50 => {
            Ok(())
        }
        _ => Err(format!("too few were read: {said}").into()),
    }
}

/// The section of code of an object file, by `size`.
fn is_small() -> Outcome {
    let folder = tempfile::tempdir()?;
    let place = folder.path().join("reader.o");
    let text = "#define LAMPLIGHT_IMPLEMENTATION\n#include \"lamplight.h\"\n";
    let file = folder.path().join("reader.c");
    std::fs::write(&file, text)?;
    output(compiler("gcc", &["-std=c99", "-O2", "-c", "-o"]).arg(&place).arg(&file))?;
    let sizes = output(Command::new("size").arg(&place))?;
    let code = sizes.lines().nth(1).and_then(|line| line.split_whitespace().next()?.parse().ok());
    let code: u64 = code.ok_or("`size` did not say a size")?;
    println!("lamplight.h: {code} bytes of code");
    if code <= MOST_CODE { Ok(()) } else { Err(format!("{code} bytes of code").into()) }
}
