//! What continuous integration runs: format, lints and tests, or one of its steps by name. Each step
//! of `.github/workflows/ci.yml` is one of these, so that all of them can be run here.

use std::process::{Command, Stdio};

use xtask::{CommandFailure, CommandResult, machine, process};

use crate::{site, test};

/// A step: its name, what it does, and the function that does it.
type CiStep = (&'static str, &'static str, fn() -> CommandResult);

const STEPS: [CiStep; 8] = [
    ("format", "rustfmt would change nothing", check_format),
    ("lints", "clippy has no warning", check_lints),
    (
        "packages",
        "the tests of every package that need nothing outside the repository",
        test::test_packages,
    ),
    ("wasm", "the toolchain of the site compiles to WebAssembly", site::check_webassembly),
    ("minimum", "the command compiles with the oldest Rust that is supported", check_minimum),
    (
        "deny",
        "licences, versions and sources of all dependencies are as deny.toml says",
        check_deny,
    ),
    ("docs", "the documentation of every package has no warning", check_docs),
    ("publish", "every package can be packed for the registry, in order", check_publishing),
];

/// Without a name: format, lints, all tests.
pub fn run(arguments: &[String]) -> CommandResult {
    let [name] = arguments else {
        if !arguments.is_empty() {
            return Err(CommandFailure::usage(usage()));
        }
        check_format()?;
        check_lints()?;
        return test::run(&[]);
    };
    match STEPS.iter().find(|(known, ..)| known == name) {
        Some((.., step)) => step(),
        None => Err(CommandFailure::usage(usage())),
    }
}

fn usage() -> String {
    let mut text = String::from("usage: cargo xtask ci [STEP]\n");
    for (name, about, _) in STEPS {
        text.push_str(&format!("\n  {name:8} {about}"));
    }
    text
}

/// Files that a build script includes are no modules to `cargo fmt`, so each file is named.
fn check_format() -> CommandResult {
    let mut list = Command::new("git");
    let listed = list.args(["ls-files", "*.rs"]).current_dir(process::root()).output();
    let listed = listed.map_err(|error| process::not_run("git ls-files", &error))?;
    let files = String::from_utf8_lossy(&listed.stdout);
    let mut rustfmt = Command::new("rustfmt");
    rustfmt.args(["--edition", "2024", "--check"]).args(files.lines()).current_dir(process::root());
    process::finish(&mut rustfmt, "rustfmt")
}

fn check_lints() -> CommandResult {
    process::cargo(&["clippy", "--workspace", "--all-targets", "--", "--deny", "warnings"], &[])
}

/// `rust-version` of `Cargo.toml`.
const MINIMUM: &str = env!("CARGO_PKG_RUST_VERSION");

/// The packages that are published, since the tests and benchmarks may use newer crates.
fn check_minimum() -> CommandResult {
    let missing = || {
        let by_hand = format!("rustup toolchain install {MINIMUM} --profile minimal");
        CommandFailure::environment(format!(
            "Rust {MINIMUM} is not installed; run\n\n    {by_hand}"
        ))
    };
    let with_minimum = |program: &str, arguments: &[&str]| {
        let mut command = Command::new("rustup");
        command.args(["run", MINIMUM, program]).args(arguments).current_dir(process::root());
        // What cargo sets for this program would choose its own version again.
        for name in ["CARGO", "RUSTC", "RUSTDOC", "RUSTUP_TOOLCHAIN"] {
            command.env_remove(name);
        }
        command
    };
    let mut probe = with_minimum("rustc", &["--version"]);
    let found = probe.stdout(Stdio::null()).stderr(Stdio::null()).status();
    if !found.is_ok_and(|status| status.success()) {
        return Err(missing());
    }
    let arguments =
        ["check", "--locked", "--package", "lamplight", "--target-dir", "target/minimum"];
    process::finish(&mut with_minimum("cargo", &arguments), "cargo check with the minimum version")
}

fn check_deny() -> CommandResult {
    const PROGRAM: &str = "cargo-deny";
    if !machine::program(PROGRAM) {
        return Err(CommandFailure::environment(format!(
            "{PROGRAM} is not installed; run\n\n    cargo install {PROGRAM} --locked"
        )));
    }
    let mut command = Command::new(PROGRAM);
    command.args(["--workspace", "check", "licenses", "bans", "sources"]);
    process::finish(command.current_dir(process::root()), PROGRAM)
}

/// Links to private items are allowed, since they serve whoever reads the sources.
fn check_docs() -> CommandResult {
    let flags = "--deny warnings --allow rustdoc::private-intra-doc-links";
    let variables = [("RUSTDOCFLAGS".to_owned(), flags.to_owned())];
    process::cargo_with(&["doc", "--workspace", "--no-deps", "--locked"], &[], &variables)
}

/// Packs every package that is published, in the order of their dependencies, and uploads none.
/// Nothing is compiled: the tests do that.
pub fn check_publishing() -> CommandResult {
    let publish = ["publish", "--workspace", "--dry-run", "--no-verify", "--allow-dirty"];
    process::cargo(&publish, &[])
}
