//! The one test command.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use serde_json::Value;

use xtask::process::{self, root};
use xtask::{CommandFailure, CommandResult, machine};

use crate::site;

/// The package that is tested. Every feature is on, since shared stores are tested with a server.
/// All tests together gain more by the optimisation than the build loses. Whoever runs `cargo test`
/// for a few of them waits for the build, so it is not in `Cargo.toml`.
const TESTED: [&str; 6] = [
    "--package",
    "lamplight",
    "--features",
    "store",
    "--config",
    "profile.test.package.lamplight.opt-level=2",
];

/// The trials themselves are not optimised, which shortens the build by more than it lengthens the
/// run: most of the time is spent in the crate.
const TRIALS: [&str; 9] = [
    "--profile",
    "test",
    "--test",
    "all",
    "--message-format",
    "json-render-diagnostics",
    "--",
    "-C",
    "opt-level=0",
];

/// Prepares the machine, then runs every test. Arguments are passed to the test binary; with names of
/// trials among them, only what these need is built.
pub fn run(arguments: &[String]) -> CommandResult {
    machine::prepare()?;
    let (names, options) = names_and_options(arguments);
    if !names.is_empty() {
        return some(&names, &options);
    }
    let incremental = incremental_state();
    // Each build has times in which only one core has work.
    let (site, trials) = std::thread::scope(|scope| {
        let site = scope.spawn(for_node_and_browser);
        let trials = build_trials(&incremental);
        (site.join(), trials)
    });
    site.unwrap_or_else(|panic| std::panic::resume_unwind(panic))?;
    process::cargo_with(&[&["test", "--doc"], &TESTED[..]].concat(), &[], &incremental)?;
    run_trials(&trials?, &with_threads(arguments))
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
    let trials = build_trials(&[])?;
    // The test binary takes one name at a time.
    names.iter().try_for_each(|name| {
        run_trials(&trials, &with_threads(&[std::slice::from_ref(name), options].concat()))
    })
}

/// The trials that run the npm package in Node, or the site in a browser.
const SITE_TRIALS: [&str; 2] = ["toolchain", "site"];

/// Builds what the trials of [`SITE_TRIALS`] run.
fn for_node_and_browser() -> CommandResult {
    site::toolchain(site::SiteBuild::Quick)?;
    site::pages()
}

/// Builds the test binary, and returns its path.
fn build_trials(variables: &[(String, String)]) -> Result<PathBuf, CommandFailure> {
    let mut command = process::cargo_command();
    command.arg("rustc").args(TESTED).args(TRIALS).stderr(Stdio::inherit());
    command.envs(variables.iter().cloned());
    let built = command.output().map_err(|error| process::not_run("cargo rustc", &error))?;
    process::succeeded(built.status, "cargo rustc --test all")?;
    let messages = String::from_utf8_lossy(&built.stdout);
    let mut executables = messages.lines().filter_map(|line| {
        let message: Value = serde_json::from_str(line).ok()?;
        let is_trials = message["target"]["name"] == "all";
        message["executable"].as_str().filter(|_| is_trials).map(PathBuf::from)
    });
    executables.next().ok_or_else(|| CommandFailure::check("cargo built no test binary"))
}

/// Variables for cargo. A first build of everything keeps no state for later ones, since the state
/// costs more than it saves on a machine that builds once.
fn incremental_state() -> Vec<(String, String)> {
    let program = std::env::current_exe().unwrap_or_default();
    let built = std::fs::read_dir(program.with_file_name("deps")).into_iter().flatten().flatten();
    let mut names = built.map(|file| file.file_name());
    match names.any(|name| name.to_string_lossy().starts_with("all-")) {
        true => Vec::new(),
        false => vec![("CARGO_INCREMENTAL".to_owned(), "0".to_owned())],
    }
}

/// glibc asks for memory in large pieces and pages, and keeps what is freed. It saves a quarter of the
/// time of glslangValidator with a small text, and 6 to 10 % of trials that start it often.
const LARGE_PAGES: &str = "glibc.malloc.hugetlb=1:glibc.malloc.top_pad=16777216:\
    glibc.malloc.mmap_threshold=1073741824:glibc.malloc.trim_threshold=1073741824";

/// Runs the test binary as `cargo test` does.
fn run_trials(trials: &Path, arguments: &[String]) -> CommandResult {
    let mut command = Command::new(trials);
    command.args(arguments).current_dir(root());
    command.env("CARGO", process::cargo_program()).env("CARGO_PKG_NAME", "lamplight");
    // Trials free much memory and soon need as much again.
    command.env("MIMALLOC_PURGE_DELAY", "1000");
    // The programs that they start, such as glslangValidator, use much memory for a short time.
    command.env("GLIBC_TUNABLES", LARGE_PAGES);
    // Mesa's software drivers compile thousands of shaders, and run most of them once. A check of the
    // whole library takes two fifths less processor time if they do not optimise the machine code,
    // and finds the same errors.
    command.env("GALLIVM_PERF", "nopt");
    process::finish(&mut command, "the tests")
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
