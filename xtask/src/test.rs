//! The one test command.

use crate::{CommandFailure, CommandResult, machine, site};
use std::process::Command;

/// All tests together gain more by this setting than the build loses. Whoever runs `cargo test` for
/// a few of them waits for the build, so it is not in `Cargo.toml`.
const OPTIMISED: [&str; 2] = ["--config", "profile.test.package.lamplight.opt-level=2"];

/// Prepares the machine, then runs every test. Arguments are passed to the test binary.
pub fn run(arguments: &[String]) -> CommandResult {
    machine::prepare()?;
    // Trials `toolchain::` run the package in Node, and trials `site::` in a browser.
    site::toolchain(site::SiteBuild::Quick)?;
    site::pages()?;
    // With every feature, since shared stores are tested with a server.
    let test = |what: &[&str], rest| {
        let package = ["test", "--package", "lamplight", "--features", "store"];
        cargo(&[&package[..], &OPTIMISED, what].concat(), rest)
    };
    test(&["--doc"], &[])?;
    test(&["--test", "all"], arguments)
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
