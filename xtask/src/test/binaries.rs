//! The test binaries of the workspace: found by their files, built together, run one after the other.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use serde_json::Value;

use xtask::process::{self, root};
use xtask::{CommandFailure, CommandResult};

/// A test binary. Its groups are the modules of its main file: the name of a test begins with that
/// of its group.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TestBinary {
    pub package: String,
    /// Name of cargo's target.
    pub target: &'static str,
    pub groups: Vec<String>,
}

impl TestBinary {
    /// Whether it has one of these groups.
    pub fn has_group(&self, groups: &[&str]) -> bool {
        self.groups.iter().any(|group| groups.contains(&group.as_str()))
    }
}

/// The binaries of the root package, with their main files. `quick` needs only the command and what
/// is in the repository; `all` has the other tests.
const OF_ROOT: [(&str, &str); 2] = [("quick", "tests/quick.rs"), ("all", "tests/main.rs")];

/// Every test binary: those of the packages below `crates/` by name, the repository's own rules, then
/// those of the root package.
pub fn find_binaries() -> Result<Vec<TestBinary>, CommandFailure> {
    let mut found = Vec::new();
    for folder in package_folders()? {
        let main = folder.join("tests/main.rs");
        if main.is_file() {
            let name = folder.file_name().unwrap_or_default().to_string_lossy();
            found.push(read_binary(format!("lamplight-{name}"), "all", &main)?);
        }
    }
    found.push(read_binary("xtask".to_owned(), "house", &root().join("xtask/tests/house.rs"))?);
    for (target, main) in OF_ROOT {
        found.push(read_binary("lamplight".to_owned(), target, &root().join(main))?);
    }
    Ok(found)
}

/// The folders below `crates/`, by name.
pub fn package_folders() -> Result<Vec<PathBuf>, CommandFailure> {
    let crates = root().join("crates");
    let entries = std::fs::read_dir(&crates)
        .map_err(|error| CommandFailure::environment(format!("{}: {error}", crates.display())))?;
    let mut folders: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    folders.sort();
    Ok(folders)
}

fn read_binary(
    package: String,
    target: &'static str,
    main: &Path,
) -> Result<TestBinary, CommandFailure> {
    let text = std::fs::read_to_string(main)
        .map_err(|error| CommandFailure::environment(format!("{}: {error}", main.display())))?;
    let module = |line: &str| line.strip_prefix("mod ")?.strip_suffix(';').map(str::to_owned);
    let mut groups: Vec<String> = text.lines().filter_map(module).collect();
    if target == "house" {
        groups.push(target.to_owned());
    }
    Ok(TestBinary { package, target, groups })
}

/// The binaries that have tests with one of the names: those with a group that the beginning of a
/// name may mean. A name that means no group may occur anywhere. Groups that are not chosen are left
/// out of the result, without names none.
pub fn choose(all: &[TestBinary], names: &[String]) -> Vec<TestBinary> {
    let mut chosen = all.to_vec();
    let means = |name: &str, group: &str| {
        let head = name.split([':', '/', ' ']).next().unwrap_or_default();
        group.starts_with(head) && !head.is_empty()
    };
    let is_known = |name: &String| {
        all.iter().flat_map(|binary| &binary.groups).any(|group| means(name, group))
    };
    if names.is_empty() || !names.iter().all(is_known) {
        return chosen;
    }
    for binary in &mut chosen {
        binary.groups.retain(|group| names.iter().any(|name| means(name, group)));
    }
    chosen.retain(|binary| !binary.groups.is_empty());
    chosen
}

/// Packages that are optimised for a run of all tests, which interpret shaders, compile every
/// permutation and draw. `Cargo.toml` has no such settings, since whoever runs the tests of one
/// package waits for its build. The command line itself takes no time.
const SLOW: [&str; 20] = [
    "bundle",
    "check",
    "compose",
    "cost",
    "diagnostic",
    "emit",
    "eval",
    "execute",
    "files",
    "generate",
    "link",
    "mutate",
    "permute",
    "picture",
    "rules",
    "scene",
    "scenes",
    "syntax",
    "validate",
    "validators",
];

/// Options of cargo that all its runs for tests share.
fn options() -> Vec<String> {
    let mut options = vec!["--features".to_owned(), "lamplight/store".to_owned()];
    for name in SLOW {
        options.push("--config".to_owned());
        options.push(format!("profile.test.package.lamplight-{name}.opt-level=2"));
    }
    options
}

/// Arguments of cargo that run the examples of the documentation of the packages that some binaries are
/// of. For other packages, cargo would choose other features of dependencies, and build most of them
/// again.
pub fn documentation_command(binaries: &[TestBinary]) -> Vec<String> {
    let packages: BTreeSet<&str> = binaries.iter().map(|binary| binary.package.as_str()).collect();
    let packages = packages.into_iter().flat_map(|package| ["--package", package]);
    let command = ["test", "--doc"].into_iter().chain(packages).map(str::to_owned);
    command.chain(options()).collect()
}

/// Arguments of cargo that run the tests of some binaries as they are built for a whole run.
pub fn one_command(binary: &TestBinary) -> Vec<String> {
    let TestBinary { package, target, groups: _ } = binary;
    let command = ["test", "--package", package, "--test", target].map(str::to_owned);
    command.into_iter().chain(options_of(package)).collect()
}

/// [`options`], for a run of cargo that may build only one package.
fn options_of(package: &str) -> Vec<String> {
    let all = options();
    if package == "lamplight" { all } else { all[2..].to_vec() }
}

/// Builds test binaries in one run of cargo, and returns their paths in the same order.
pub fn build(
    binaries: &[TestBinary],
    variables: &[(String, String)],
) -> Result<Vec<PathBuf>, CommandFailure> {
    let mut command = process::cargo_command();
    command.args(["test", "--no-run", "--message-format", "json-render-diagnostics"]);
    for TestBinary { package, target, groups: _ } in binaries {
        command.args(["--package", package, "--test", target]);
    }
    let has_root = binaries.iter().any(|binary| binary.package == "lamplight");
    command.args(options_of(if has_root { "lamplight" } else { "" }));
    command.stderr(Stdio::inherit()).envs(variables.iter().cloned());
    let built = command.output().map_err(|error| process::not_run("cargo test", &error))?;
    process::succeeded(built.status, "cargo test --no-run")?;
    let messages = String::from_utf8_lossy(&built.stdout);
    let made: Vec<Value> =
        messages.lines().filter_map(|line| serde_json::from_str(line).ok()).collect();
    binaries.iter().map(|binary| executable(&made, binary)).collect()
}

/// The path of a binary by the messages of the run that built it.
fn executable(messages: &[Value], binary: &TestBinary) -> Result<PathBuf, CommandFailure> {
    let TestBinary { package, target, groups: _ } = binary;
    let is_its = |message: &&Value| {
        // An address, `#`, and `lamplight-eval@0.1.0`; or only the version, if the last folder of
        // the address has the package's name.
        let id = message["package_id"].as_str().unwrap_or_default();
        let (folder, version) = id.rsplit_once('#').unwrap_or((id, ""));
        let name = match version.split_once('@') {
            Some((name, _)) => name,
            None => folder.rsplit('/').next().unwrap_or_default(),
        };
        name == package && message["target"]["name"] == *target
    };
    let found = messages.iter().filter(is_its).find_map(|message| message["executable"].as_str());
    let path = found.map(PathBuf::from);
    path.ok_or_else(|| CommandFailure::check(format!("cargo built no test binary of {package}")))
}

/// glibc asks for memory in large pieces and pages, and keeps what is freed. It saves a quarter of the
/// time of glslangValidator with a small text, and 6 to 10 % of tests that start it often.
const LARGE_PAGES: &str = "glibc.malloc.hugetlb=1:glibc.malloc.top_pad=16777216:\
    glibc.malloc.mmap_threshold=1073741824:glibc.malloc.trim_threshold=1073741824";

/// Runs binaries one after the other, even after one that fails.
pub fn run_all(paths: &[PathBuf], options: &[String]) -> CommandResult {
    let mut outcome = Ok(());
    for path in paths {
        outcome = outcome.and(run_binary(path, options));
    }
    outcome
}

/// Runs the tests that have one of the names in theirs, even after one that fails. A name that no
/// test has is an error, since nothing would be tested.
pub fn run_named(paths: &[PathBuf], names: &[String], options: &[String]) -> CommandResult {
    let mut outcome = Ok(());
    for name in names {
        let arguments = [std::slice::from_ref(name), options].concat();
        let mut is_known = false;
        for path in paths {
            if has_tests(path, &arguments)? {
                is_known = true;
                outcome = outcome.and(run_binary(path, &arguments));
            }
        }
        if !is_known {
            let message = format!("no test has `{name}` in its name");
            outcome = outcome.and(Err(CommandFailure::check(message)));
        }
    }
    outcome
}

/// Whether a test binary would run any test with these arguments.
fn has_tests(path: &Path, arguments: &[String]) -> Result<bool, CommandFailure> {
    let mut command = Command::new(path);
    command.arg("--list").args(arguments).current_dir(root());
    let listed = command.stderr(Stdio::inherit()).output();
    let listed = listed.map_err(|error| process::not_run(&path.to_string_lossy(), &error))?;
    process::succeeded(listed.status, "listing the tests")?;
    Ok(!listed.stdout.trim_ascii().is_empty())
}

/// Runs a test binary as `cargo test` does.
fn run_binary(path: &Path, arguments: &[String]) -> CommandResult {
    let mut command = Command::new(path);
    command.args(arguments).current_dir(root());
    command.env("CARGO", process::cargo_program()).env("CARGO_PKG_NAME", "lamplight");
    // Tests free much memory and soon need as much again.
    command.env("MIMALLOC_PURGE_DELAY", "1000");
    // The programs that they start, such as glslangValidator, use much memory for a short time.
    command.env("GLIBC_TUNABLES", LARGE_PAGES);
    // Mesa's software drivers compile thousands of shaders, and run most of them once. A check of the
    // whole library takes two fifths less processor time if they do not optimise the machine code,
    // and finds the same errors.
    command.env("GALLIVM_PERF", "nopt");
    process::finish(&mut command, "the tests")
}
