//! The one test command, and its parts: `test fast`, `test nightly`, `test NAME...`.

mod binaries;
mod fast;
mod needs;
mod nightly;

use xtask::{CommandResult, machine, process};

use crate::site;

pub use binaries::{choose, find_binaries, one_command};
pub use fast::test_packages;

/// Prepares the machine, then runs every test. With names among the arguments, only the tests that
/// have one of them in theirs are built and run, and only what these need is installed. Other
/// arguments are passed to the test binaries.
pub fn run(arguments: &[String]) -> CommandResult {
    match arguments.first().map(String::as_str) {
        Some("fast") => return fast::run(&arguments[1..]),
        Some("nightly") => return nightly::run(&arguments[1..]),
        _ => {}
    }
    let (names, options) = names_and_options(arguments);
    let all = binaries::find_binaries()?;
    let chosen = binaries::choose(&all, &names);
    machine::prepare(&needs::of_groups(&chosen))?;
    let options = with_threads(&options);
    if names.is_empty() {
        return everything(&chosen, &options);
    }
    if chosen.iter().any(|binary| binary.has_group(&site::GROUPS)) {
        for_node_and_browser()?;
    }
    let paths = binaries::build(&chosen, &[])?;
    binaries::run_named(&paths, &names, &options)
}

/// Builds and runs every test, those of the documentation too.
fn everything(chosen: &[binaries::TestBinary], options: &[String]) -> CommandResult {
    let incremental = incremental_state();
    // Each build has times in which only one core has work.
    let (site, paths) = std::thread::scope(|scope| {
        let site = scope.spawn(for_node_and_browser);
        let paths = binaries::build(chosen, &incremental);
        (site.join(), paths)
    });
    site.unwrap_or_else(|panic| std::panic::resume_unwind(panic))?;
    let examples = binaries::documentation_command(chosen);
    let examples: Vec<&str> = examples.iter().map(String::as_str).collect();
    process::cargo_with(&examples, &[], &incremental)?;
    binaries::run_all(&paths?, options)
}

/// Options of a test binary whose value is the next argument.
const WITH_VALUE: [&str; 5] = ["--color", "--format", "--logfile", "--skip", "--test-threads"];

/// Separates the names of tests from the options.
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

/// Builds what the tests of [`site::GROUPS`] run.
fn for_node_and_browser() -> CommandResult {
    site::toolchain(site::SiteBuild::Quick)?;
    site::pages()
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

/// The arguments with a number of threads, unless they have one. It is one more than there are
/// cores, since tests wait for browsers and other programs.
fn with_threads(arguments: &[String]) -> Vec<String> {
    const OPTION: &str = "--test-threads";
    let mut all = arguments.to_vec();
    if !all.iter().any(|one| one.starts_with(OPTION)) {
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        all.push(format!("{OPTION}={}", cores + 1));
    }
    all
}
