//! `cargo xtask frames`: permutations of programs, drawn from the bytes that a bundle holds of
//! each target, by the tests `frames/shipped` and `metal::frames`; without `--target`, from the
//! sources too, in both languages on both backends, by the tests `frames/`.

use xtask::process::{self, root};
use xtask::{CommandFailure, CommandResult};

fn usage() -> CommandFailure {
    CommandFailure::usage(format!(
        "usage: cargo xtask frames [--permutations N] [--target T[,T]]

  --permutations N  how many of each program and language (all: 200 or more, with all pairs of values)
  --target T        of {} (all)",
        targets().join(", ")
    ))
}

/// Every target has a file of its name.
fn targets() -> Vec<String> {
    let files =
        std::fs::read_dir(root().join("crates/emit/src/targets")).into_iter().flatten().flatten();
    let names = files.map(|file| file.file_name().to_string_lossy().into_owned());
    let mut targets: Vec<String> =
        names.filter_map(|name| name.strip_suffix(".rs").map(str::to_owned)).collect();
    targets.sort();
    targets
}

/// Runs the tests. A wrong picture gives exit code 3.
pub fn run(arguments: &[String]) -> CommandResult {
    let (mut permutations, mut targets) = ("100000".to_owned(), Vec::new());
    let mut rest = arguments.iter();
    while let Some(argument) = rest.next() {
        let value = rest.next().ok_or_else(usage)?;
        match argument.as_str() {
            "--permutations" if value.parse::<usize>().is_ok() => permutations = value.clone(),
            "--target" => targets.extend(value.split(',').map(str::to_owned)),
            _ => return Err(usage()),
        }
    }
    // MSL has a test of its own, which compiles many stages at once.
    let msl = targets.is_empty() || targets.iter().any(|target| target == "msl");
    let is_other = |target: &String| target != "msl";
    let mut variables = vec![("LAMPLIGHT_FRAMES_PERMUTATIONS".to_owned(), permutations)];
    let others: Vec<String> = targets.iter().filter(|one| is_other(one)).cloned().collect();
    if !others.is_empty() {
        variables.push(("LAMPLIGHT_FRAMES_TARGETS".to_owned(), others.join(",")));
    }
    if targets.is_empty() {
        tests("frames/", &variables)?;
    } else if !others.is_empty() {
        tests("frames/shipped", &variables)?;
    }
    if msl { tests("metal::frames", &variables) } else { Ok(()) }
}

fn tests(name: &str, variables: &[(String, String)]) -> CommandResult {
    let command =
        ["test", "--quiet", "--package", "lamplight", "--features", "store", "--test", "all"];
    process::cargo_with(&command, &[name.to_owned(), "--nocapture".to_owned()], variables)
}
