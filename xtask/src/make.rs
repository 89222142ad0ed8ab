//! Commands that use the crate. They are a package of their own, `xtask/make/`, which is built when
//! one of them is wanted.

use xtask::{CommandFailure, CommandResult, process};

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

/// `cargo xtask gen`.
pub fn generate(arguments: &[String]) -> CommandResult {
    run("gen", arguments)
}

/// `cargo xtask new`.
pub fn create(arguments: &[String]) -> CommandResult {
    run("new", arguments)
}

/// `cargo xtask fuzz`.
pub fn fuzz(arguments: &[String]) -> CommandResult {
    run("fuzz", arguments)
}

/// `cargo xtask validate`.
pub fn validate(arguments: &[String]) -> CommandResult {
    run("validate", arguments)
}

/// Runs a command with its own exit code.
fn run(name: &str, arguments: &[String]) -> CommandResult {
    let mut command = process::cargo_command();
    command.args(RUN).arg(name).args(arguments);
    let status = command.status().map_err(|error| process::not_run("cargo run", &error))?;
    match status.code() {
        Some(0) => Ok(()),
        code => {
            Err(CommandFailure::printed(code.and_then(|code| u8::try_from(code).ok()).unwrap_or(3)))
        }
    }
}
