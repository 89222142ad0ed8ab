//! Runs cargo and other programs in the workspace.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus};

use crate::{CommandFailure, CommandResult};

/// The workspace.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap_or(Path::new(".")).to_owned()
}

/// Runs cargo; a failure is exit code 3.
pub fn cargo(arguments: &[&str], rest: &[String]) -> CommandResult {
    cargo_with(arguments, rest, &[])
}

/// [`cargo`] with variables in its environment.
pub fn cargo_with(
    arguments: &[&str],
    rest: &[String],
    variables: &[(String, String)],
) -> CommandResult {
    let mut command = cargo_command();
    command.args(arguments).envs(variables.iter().cloned());
    if !rest.is_empty() {
        command.arg("--").args(rest);
    }
    finish(&mut command, &format!("cargo {}", arguments.join(" ")))
}

/// The cargo that runs this command.
pub fn cargo_program() -> OsString {
    std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into())
}

/// Cargo without arguments.
pub fn cargo_command() -> Command {
    let mut command = Command::new(cargo_program());
    command.current_dir(root());
    command
}

/// Runs a command to its end; a failure is exit code 3.
pub fn finish(command: &mut Command, name: &str) -> CommandResult {
    let status = command.status().map_err(|error| not_run(name, &error))?;
    succeeded(status, name)
}

/// Exit code 3 unless a command succeeded.
pub fn succeeded(status: ExitStatus, name: &str) -> CommandResult {
    if status.success() { Ok(()) } else { Err(CommandFailure::check(format!("failed: {name}"))) }
}

/// The exit code of a command that has printed why it failed.
pub fn same_exit_code(status: ExitStatus) -> CommandResult {
    let code = status.code().and_then(|code| u8::try_from(code).ok());
    if status.success() { Ok(()) } else { Err(CommandFailure::printed(code.unwrap_or(3))) }
}

/// Exit code 4, since a command did not start.
pub fn not_run(name: &str, error: &std::io::Error) -> CommandFailure {
    CommandFailure::environment(format!("{name} could not be run: {error}"))
}

/// The command `lamplight`, built now in the profile of this program.
pub fn beside_this() -> Result<PathBuf, CommandFailure> {
    let own = std::env::current_exe().map_err(|error| not_run("lamplight", &error))?;
    // The folder is named after the profile, but for that of `dev`.
    let folder = own.parent().and_then(Path::file_name).and_then(|name| name.to_str());
    let profile = folder.map_or("dev", |name| if name == "debug" { "dev" } else { name });
    cargo(&["build", "--quiet", "--package", "lamplight", "--profile", profile], &[])?;
    Ok(own.with_file_name("lamplight"))
}
