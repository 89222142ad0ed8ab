//! `cargo xtask check PATH...`: the numeric cases of modules as they are on the disk, by the command
//! as it was built. A change of a shader compiles nothing.

use std::path::{Path, PathBuf};
use std::process::Command;

use xtask::process::{self, root};
use xtask::{CommandFailure, CommandResult};

/// Checks modules of `shaderlib/`, such as `brdf/fresnel`, or folders of them. Everything from the
/// first option on is passed to `lamplight check`.
pub fn run(arguments: &[String]) -> CommandResult {
    let is_option = |argument: &String| argument.starts_with('-');
    let options = arguments.iter().position(is_option).unwrap_or(arguments.len());
    let (names, options) = arguments.split_at(options);
    if names.is_empty() {
        return Err(CommandFailure::usage(
            "usage: cargo xtask check PATH... [OPTION]..., such as `cargo xtask check brdf/fresnel`",
        ));
    }
    let library = root().join("shaderlib");
    let cases: Vec<PathBuf> =
        names.iter().map(|name| find_cases(&library, name)).collect::<Result<_, _>>()?;
    let mut command = Command::new(built_command()?);
    command.arg("check").args(cases).args(options).current_dir(root());
    let status = command.status().map_err(|error| process::not_run("lamplight check", &error))?;
    process::same_exit_code(status)
}

/// The file of cases, or the folder, that a name means: `brdf/fresnel`, `brdf::fresnel`,
/// `brdf/fresnel.toml`, `shaderlib/brdf/fresnel.wesl`, `brdf`.
fn find_cases(library: &Path, name: &str) -> Result<PathBuf, CommandFailure> {
    let below = name.replace("::", "/");
    let below = below.strip_prefix("shaderlib/").unwrap_or(&below).trim_end_matches('/');
    let folder = library.join(below);
    if folder.is_dir() {
        return Ok(folder);
    }
    let file = folder.with_extension("toml");
    match file.is_file() {
        true => Ok(file),
        false => Err(CommandFailure::input(format!("there is no `shaderlib/{below}.toml`"))),
    }
}

/// The command as it was built last, with or without optimisation; it is built if it never was.
fn built_command() -> Result<PathBuf, CommandFailure> {
    let name = format!("lamplight{}", std::env::consts::EXE_SUFFIX);
    let beside = std::env::current_exe().map_err(|error| process::not_run("lamplight", &error))?;
    let built = beside.with_file_name(name);
    if !built.is_file() {
        process::cargo(&["build", "--quiet", "--package", "lamplight"], &[])?;
    }
    Ok(built)
}
