//! Lists the files of `src/executors/` that this system can have.

#![allow(clippy::print_stdout)]

use std::path::Path;
use std::{env, fs, io};

use lamplight_build::{modules, write_table};

fn main() -> io::Result<()> {
    write_table("executors.rs", &modules("src/executors", "EXECUTOR", "ExecutorEntry", runs_here)?)
}

/// Whether an executor can be had on the system that the package is built for. The line `Runs on:` of
/// its file says so: `every system`, `every system but WebAssembly`, or names of systems as
/// `target_os` has them.
fn runs_here(file: &Path) -> io::Result<bool> {
    println!("cargo::rerun-if-changed={}", file.display());
    let family = env::var("CARGO_CFG_TARGET_FAMILY").unwrap_or_default();
    let is_wasm = family.split(',').any(|name| name == "wasm");
    let system = env::var("CARGO_CFG_TARGET_OS").unwrap_or_default();
    let text = fs::read_to_string(file)?;
    let line = text.lines().find_map(|line| line.strip_prefix("//! Runs on: "));
    match line {
        Some("every system") => Ok(true),
        Some("every system but WebAssembly") => Ok(!is_wasm),
        Some(names) if names.split(", ").all(|name| SYSTEMS.contains(&name)) => {
            Ok(names.split(", ").any(|name| name == system))
        }
        _ => {
            let what = "a line `//! Runs on: ` is needed, with `every system`, `every system but \
                WebAssembly`, or some of";
            let systems = SYSTEMS.join(", ");
            Err(io::Error::other(format!("{}: {what} `{systems}`", file.display())))
        }
    }
}

/// The systems that a line `Runs on:` may name.
const SYSTEMS: [&str; 6] = ["android", "freebsd", "ios", "linux", "macos", "windows"];
