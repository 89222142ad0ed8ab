//! Commands that use the crate. They are a package of their own, `xtask/make/`, which is built when
//! one of them is wanted.

use xtask::{CommandResult, process};

/// Not incremental: a fresh clone builds this once, and should soon have its bundle.
const RUN: [&str; 7] = [
    "run",
    "--quiet",
    "--package",
    "lamplight-make",
    "--config",
    "profile.dev.incremental=false",
    "--",
];

/// Runs a command with its own exit code.
pub fn run(name: &str, arguments: &[String]) -> CommandResult {
    let mut command = process::cargo_command();
    command.args(RUN).arg(name).args(arguments);
    let status = command.status().map_err(|error| process::not_run("cargo run", &error))?;
    process::same_exit_code(status)
}
