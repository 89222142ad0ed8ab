//! The one test command.

use crate::{CommandFailure, CommandResult, machine, site};
use std::process::Command;

/// All tests together gain more by this setting than the build loses. Whoever runs `cargo test` for
/// a few of them waits for the build, so it is not in `Cargo.toml`.
const OPTIMISED: [&str; 2] = ["--config", "profile.test.package.lamplight.opt-level=2"];

/// Prepares the machine, then runs every test. Arguments are passed to the test binary; with names of
/// trials among them, only what these need is built.
pub fn run(arguments: &[String]) -> CommandResult {
    machine::prepare()?;
    let (names, options) = names_and_options(arguments);
    if !names.is_empty() {
        return some(&names, &options);
    }
    // Each build has times in which only one core has work.
    let (site, tests) = std::thread::scope(|scope| {
        let site = scope.spawn(for_node_and_browser);
        let tests = test(&["--test", "all", "--no-run"], &[]);
        (site.join(), tests)
    });
    site.unwrap_or_else(|panic| std::panic::resume_unwind(panic))?;
    tests?;
    test(&["--doc"], &[])?;
    test(&["--test", "all"], &with_threads(arguments))
}

/// Options of the test binary whose value is the next argument.
const WITH_VALUE: [&str; 5] = ["--color", "--format", "--logfile", "--skip", "--test-threads"];

/// Separates the names of trials from the options.
fn names_and_options(arguments: &[String]) -> (Vec<String>, Vec<String>) {
    let (mut names, mut options, mut is_value) = (Vec::new(), Vec::new(), false);
    for argument in arguments.iter().cloned() {
        if is_value || argument.starts_with('-') {
            is_value = !is_value && WITH_VALUE.contains(&argument.as_str());
            options.push(argument);
        } else {
            names.push(argument);
        }
    }
    (names, options)
}

/// Runs the trials that have one of some names in theirs.
fn some(names: &[String], options: &[String]) -> CommandResult {
    let of_site = |name: &String| SITE_TRIALS.iter().any(|group| name.starts_with(group));
    if names.iter().any(of_site) {
        for_node_and_browser()?;
    }
    // The test binary takes one name at a time.
    names.iter().try_for_each(|name| {
        test(&["--test", "all"], &with_threads(&[&[name.clone()], options].concat()))
    })
}

/// The trials that run the npm package in Node, or the site in a browser.
const SITE_TRIALS: [&str; 2] = ["toolchain", "site"];

/// Builds what the trials of [`SITE_TRIALS`] run.
fn for_node_and_browser() -> CommandResult {
    site::toolchain(site::SiteBuild::Quick)?;
    site::pages()
}

/// `cargo test` with every feature, since shared stores are tested with a server.
fn test(what: &[&str], rest: &[String]) -> CommandResult {
    let package = ["test", "--package", "lamplight", "--features", "store"];
    // Trials free much memory and soon need as much again.
    let kept = [("MIMALLOC_PURGE_DELAY".to_owned(), "1000".to_owned())];
    cargo_with(&[&package[..], &OPTIMISED, what].concat(), rest, &kept)
}

/// The arguments with a number of threads, unless they have one. It is one more than there are
/// cores, since trials wait for browsers and other programs.
fn with_threads(arguments: &[String]) -> Vec<String> {
    const OPTION: &str = "--test-threads";
    let mut all = arguments.to_vec();
    if !all.iter().any(|one| one.starts_with(OPTION)) {
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        all.push(format!("{OPTION}={}", cores + 1));
    }
    all
}

/// Runs cargo in the workspace; a failure is exit code 3.
pub fn cargo(arguments: &[&str], rest: &[String]) -> CommandResult {
    cargo_with(arguments, rest, &[])
}

/// [`cargo`] with variables in its environment.
pub fn cargo_with(
    arguments: &[&str],
    rest: &[String],
    variables: &[(String, String)],
) -> CommandResult {
    let mut command = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.envs(variables.iter().cloned());
    command.args(arguments).current_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/.."));
    if !rest.is_empty() {
        command.arg("--").args(rest);
    }
    match command.status() {
        Ok(status) if status.success() => Ok(()),
        Ok(_) => Err(CommandFailure::check(format!("failed: cargo {}", arguments.join(" ")))),
        Err(error) => Err(CommandFailure::environment(format!("cargo could not be run: {error}"))),
    }
}
