//! Puts mistakes into the library, to see whether its numeric cases notice them.

use xtask::{CommandResult, process};

/// Runs `lamplight mutate` over the library's sources, in release: it makes thousands of mutants.
/// Arguments (modules, `--coverage`, `--shared`) are passed on.
pub fn run(arguments: &[String]) -> CommandResult {
    let command = ["run", "--quiet", "--release", "--package", "lamplight", "--", "mutate"];
    let all: Vec<&str> = command
        .into_iter()
        .chain(["--root", "shaderlib"])
        .chain(arguments.iter().map(String::as_str))
        .collect();
    process::cargo(&all, &[])
}
